// A vector on cache-line boundaries, whose elements `resize` leaves uninitialised: the kernels
// write them before anything reads them. Other objects may keep its memory when the vector no
// longer uses it.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace snowshed {

/// The number of holders of a piece of memory; it is stored just before the first element.
class alignas(64) MemoryHolders {
 public:
  static MemoryHolders& of(const void* first_element) {
    return static_cast<MemoryHolders*>(const_cast<void*>(first_element))[-1];
  }
  void add() { count_.fetch_add(1, std::memory_order_relaxed); }
  void release() {
    if (count_.fetch_sub(1, std::memory_order_acq_rel) == 1)
      ::operator delete(this, std::align_val_t(alignof(MemoryHolders)));
  }

 private:
  std::atomic<std::ptrdiff_t> count_{1};
};

template <class T>
struct AlignedAllocator {
  using value_type = T;
  static_assert(std::is_trivially_destructible_v<T>, "others may still read its elements");

  AlignedAllocator() = default;
  template <class U>
  AlignedAllocator(const AlignedAllocator<U>&) {}

  T* allocate(std::size_t n) {
    void* memory = ::operator new(sizeof(MemoryHolders) + n * sizeof(T),
                                  std::align_val_t(alignof(MemoryHolders)));
    return reinterpret_cast<T*>(::new (memory) MemoryHolders + 1);
  }
  void deallocate(T* p, std::size_t) { MemoryHolders::of(p).release(); }

  template <class U>
  void construct(U* p) {
    ::new (static_cast<void*>(p)) U;  // default-initialised: no zeros for numbers
  }
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }

  template <class U>
  bool operator==(const AlignedAllocator<U>&) const {
    return true;
  }
  template <class U>
  bool operator!=(const AlignedAllocator<U>&) const {
    return false;
  }
};

template <class T>
using AlignedVector = std::vector<T, AlignedAllocator<T>>;

/// The elements of a vector. The pointer keeps their memory when the vector grows or is destroyed.
/// Null if the vector never held any.
template <class T>
std::shared_ptr<const T> share(const AlignedVector<T>& vector) {
  if (vector.capacity() == 0) return nullptr;
  MemoryHolders& holders = MemoryHolders::of(vector.data());
  holders.add();
  return {vector.data(), [&holders](const T*) { holders.release(); }};
}

}  // namespace snowshed
