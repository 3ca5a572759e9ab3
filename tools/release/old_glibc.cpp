// Functions that glibc before 2.36 lacks, for wheels (OldGlibc.cmake). They are hidden, so that only
// the extension uses them. No header declares them here, because its types would differ.
#include <sys/syscall.h>

#define SNOWSHED_HIDDEN __attribute__((visibility("hidden")))

extern "C" {

long syscall(long number, ...);

// The C++ library asks this before it counts references without atomic operations; false is safe.
SNOWSHED_HIDDEN char __libc_single_threaded = 0;

SNOWSHED_HIDDEN int fstat64(int file, void* facts) { return int(syscall(SYS_fstat, file, facts)); }
SNOWSHED_HIDDEN int stat64(const char* path, void* facts) {
  return int(syscall(SYS_stat, path, facts));
}
SNOWSHED_HIDDEN int lstat64(const char* path, void* facts) {
  return int(syscall(SYS_lstat, path, facts));
}
SNOWSHED_HIDDEN int fstat(int file, void* facts) { return fstat64(file, facts); }
SNOWSHED_HIDDEN int stat(const char* path, void* facts) { return stat64(path, facts); }
SNOWSHED_HIDDEN int lstat(const char* path, void* facts) { return lstat64(path, facts); }

SNOWSHED_HIDDEN unsigned arc4random() {
  unsigned number = 0;
  while (syscall(SYS_getrandom, &number, sizeof number, 0) != long(sizeof number)) {
  }
  return number;
}

}  // extern "C"
