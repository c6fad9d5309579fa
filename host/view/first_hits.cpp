// SPDX-License-Identifier: Apache-2.0
// See first_hits.h.
#include "host/view/first_hits.h"

#include <algorithm>

namespace turbid {

const RasterImage& FirstHits::of(std::span<const RasterMesh> meshes, const RasterView& view) {
  constexpr std::size_t kMost = 2;
  const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.view == view; });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
  } else {
    if (kept_.size() == kMost) kept_.pop_back();  // before the new one takes its memory
    kept_.push_front({view, rasterise(meshes, view)});
  }
  return kept_.front().image;
}

}  // namespace turbid
