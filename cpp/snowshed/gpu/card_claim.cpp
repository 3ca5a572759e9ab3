#include "snowshed/gpu/card_claim.hpp"

#include <filesystem>

#include "snowshed/core/errors.hpp"
#include "snowshed/gpu/cache_folder.hpp"

namespace snowshed::gpu {
namespace {

namespace fs = std::filesystem;

constexpr int max_claims_per_card = 64;

/// A claim by the lock on a folder; none if another run holds it.
std::shared_ptr<const io::FolderLock> try_to_claim(const fs::path& folder) {
  fs::create_directories(folder);
  try {
    return std::make_shared<const io::FolderLock>(folder);
  } catch (const InputError&) {
    return nullptr;
  }
}

}  // namespace

ClaimedCard claim_card(const std::vector<std::string>& identifiers) {
  const fs::path cache = cache_folder();
  if (identifiers.size() < 2 || cache.empty()) return {};
  try {
    for (int claim = 0; claim < max_claims_per_card; ++claim)
      for (std::size_t card = 0; card < identifiers.size(); ++card) {
        const fs::path folder = cache / "cards" / identifiers[card] / std::to_string(claim);
        if (auto lock = try_to_claim(folder)) return {int(card), std::move(lock)};
      }
  } catch (const FileError&) {  // runs share the first card where no folder can be locked
  } catch (const fs::filesystem_error&) {
  }
  return {};
}

}  // namespace snowshed::gpu
