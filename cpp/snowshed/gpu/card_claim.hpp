// Claims on graphics cards, so that runs that compute at the same time take different ones.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "snowshed/io/folder_lock.hpp"

namespace snowshed::gpu {

/// A card, by its number in a list, and the claim on it. The claim ends with the last copy, or with
/// the process.
struct ClaimedCard {
  int number = 0;
  std::shared_ptr<const io::FolderLock> claim;  // none: there was no choice, or no folder for locks
};

/// Claims the card on which the fewest runs of this user compute, the first one of several. The
/// cards are given by identifiers that are the same in all processes.
ClaimedCard claim_card(const std::vector<std::string>& identifiers);

}  // namespace snowshed::gpu
