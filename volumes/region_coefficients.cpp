// SPDX-License-Identifier: Apache-2.0
// A region's coefficients: constants stay constants, varying fields are evaluated at the voxel centres of the blocks
// that the region touches and of their neighbours. Values at voxels that the region owns must be physical, else
// InputError; elsewhere a formula may misbehave, and its values are only made valid.
#include <tbb/parallel_for.h>

#include <cmath>
#include <cstdio>
#include <mutex>

#include "host/base/errors.h"
#include "volumes/medium_grids.h"

namespace turbid {
namespace {

/// What values a coefficient may have.
struct Rule {
  const char* name;
  float lowest;      ///< smallest allowed value, or the open end of the range of g
  float lowest_elsewhere;  ///< at voxels that the region does not own, where values serve interpolation only
  bool mean_cosine;  ///< in (-1, 1)
  const char* expected;

  bool allows(float v) const {
    if (mean_cosine) return v > -1.0f && v < 1.0f;
    return std::isfinite(v) && v >= lowest - 1e-5f * lowest;  // an index of 1 may be rounded down
  }
  float made_valid(float v) const {
    if (mean_cosine) return std::isnan(v) ? 0.0f : std::clamp(v, -0.999f, 0.999f);
    return std::isfinite(v) ? std::max(v, lowest_elsewhere) : lowest;
  }
};
constexpr Rule kEta{"eta", 1.0f, 0.3f, false, "a finite number >= 1"};
constexpr Rule kSigmaS{"sigma_s", 0.0f, 0.0f, false, "a finite number >= 0 [1/scene unit]"};
constexpr Rule kSigmaA{"sigma_a", 0.0f, 0.0f, false, "a finite number >= 0 [1/scene unit]"};
constexpr Rule kEmission{"emission", 0.0f, 0.0f, false, "a finite number >= 0 [W/scene unit^3]"};
constexpr Rule kMeanCosine{"g", -1.0f, -1.0f, true, "a number in (-1, 1)"};

std::string format(const char* pattern, double a, double b = 0, double c = 0) {
  char text[128];
  std::snprintf(text, sizeof text, pattern, a, b, c);
  return text;
}

[[noreturn]] void refuse(const Material& material, const Rule& rule, glm::vec3 v, const std::string& place) {
  const bool grey = (v.x == v.y && v.y == v.z) || (std::isnan(v.x) && std::isnan(v.y) && std::isnan(v.z));
  const std::string value = grey ? format("%g", v.x) : format("(%g, %g, %g)", v.x, v.y, v.z);
  throw InputError("material \"" + material.name + "\": " + rule.name + " = " + value + place + ": must be " +
                   rule.expected);
}

/// `channels`: 3 for colours, 1 for eta and g, whose three are equal.
bool allows(const Rule& rule, glm::vec3 v, int channels) {
  for (int c = 0; c < channels; ++c)
    if (!rule.allows(v[c])) return false;
  return true;
}
glm::vec3 made_valid(const Rule& rule, glm::vec3 v) {
  return {rule.made_valid(v.x), rule.made_valid(v.y), rule.made_valid(v.z)};
}

void put(float& to, glm::vec3 v) {
  to = v.x;
}
void put(openvdb::Vec3s& to, glm::vec3 v) {
  to = {v.x, v.y, v.z};
}

/// Blocks that hold a voxel centre of the region or come within a voxel of one, and all their neighbours.
std::vector<int> blocks_near(const MediumVolume::Grids& medium, int r) {
  const glm::ivec3 blocks = medium.frame.blocks();
  std::vector<char> wanted(block_count(blocks), r == 0);
  if (r > 0) {
    const auto& tree = medium.fields[r].signed_distance->tree();
    std::vector<char> touched(wanted.size());
    tbb::parallel_for(0, block_count(blocks), [&](int i) {
      const auto at = first_voxel(block_at(blocks, i));
      if (const auto* leaf = tree.probeConstLeaf(at)) {
        const float* d = leaf->buffer().data();
        touched[i] = std::any_of(d, d + kBlockVoxels, [](float v) { return v < 1.0f; });
      } else {
        touched[i] = tree.getValue(at) < 0;
      }
    });
    for (int i = 0; i < block_count(blocks); ++i) {
      if (!touched[i]) continue;
      const glm::ivec3 at = block_at(blocks, i);
      for (int n = 0; n < 27; ++n) {
        glm::ivec3 to = at + glm::ivec3(n % 3, n / 3 % 3, n / 9) - 1;
        bool exists = true;
        for (int axis = 0; axis < 3; ++axis) {
          if (medium.periodic(axis)) to[axis] = (to[axis] + blocks[axis]) % blocks[axis];
          exists = exists && to[axis] >= 0 && to[axis] < blocks[axis];
        }
        if (exists) wanted[(to.z * blocks.y + to.y) * blocks.x + to.x] = 1;
      }
    }
  }
  std::vector<int> list;
  for (int i = 0; i < block_count(blocks); ++i)
    if (wanted[i]) list.push_back(i);
  return list;
}

struct Evaluated {
  glm::vec3 mean{0};      ///< over the voxels that the region owns
  bool positive = false;  ///< somewhere there
};

/// Evaluates a varying field on `blocks` of region r. The result does not depend on the number of threads.
template <class GridT>
Evaluated evaluate(const MediumVolume::Grids& medium, int r, const Material& material, const Rule& rule,
                   const Field& field, const std::vector<int>& blocks, const StepProgress& within,
                   typename GridT::Ptr& grid) {
  constexpr int together = 8;  // blocks of one call: amortises what an implementation sets up per call
  constexpr int calls_per_report = 64;
  const GridFrame& frame = medium.frame;
  const int channels = sizeof(typename GridT::ValueType) / sizeof(float);
  std::vector<BlockContent<GridT>> contents(block_count(frame.blocks()));
  struct Sum {
    glm::dvec3 values{0};
    int count = 0;
    bool positive = false;
  };
  std::vector<Sum> sums(blocks.size());
  std::mutex guard;
  std::size_t bad_block = blocks.size();  // the first in order, whichever thread sees it first
  int bad_voxel = 0;
  glm::vec3 bad_value{0};

  const auto evaluate_blocks = [&](std::size_t begin, std::size_t end) {
    std::vector<glm::vec3> positions, values((end - begin) * kBlockVoxels);
    positions.reserve(values.size());
    for (std::size_t b = begin; b < end; ++b) {
      const glm::ivec3 at = block_at(frame.blocks(), blocks[b]) * kBlockEdge;
      for (int v = 0; v < kBlockVoxels; ++v)
        positions.push_back(frame.centre_of(at + glm::ivec3(v & 7, (v >> 3) & 7, v >> 6)));
    }
    field.evaluate(positions, values);
    for (std::size_t b = begin; b < end; ++b) {
      const glm::ivec3 block = block_at(frame.blocks(), blocks[b]);
      const glm::vec3* value = &values[(b - begin) * kBlockVoxels];
      auto leaf = make_leaf<GridT>(block, typename GridT::ValueType(0.0f), true);
      std::array<int, kBlockVoxels> owner;
      read_box(*medium.owner, frame, block * kBlockEdge, glm::ivec3(kBlockEdge),
               [&](std::size_t i, int o) { owner[i] = o; });
      Sum& sum = sums[b];
      for_block_voxels([&](int voxel, int offset) {
        const glm::vec3 valid = made_valid(rule, value[voxel]);
        put(leaf->buffer().data()[offset], valid);
        if (owner[voxel] != r) return;
        sum.values += glm::dvec3(valid);
        ++sum.count;
        sum.positive = sum.positive || valid.x > 0 || valid.y > 0 || valid.z > 0;
        if (allows(rule, value[voxel], channels)) return;
        const std::lock_guard lock(guard);
        if (b < bad_block || (b == bad_block && voxel < bad_voxel)) {
          bad_block = b;
          bad_voxel = voxel;
          bad_value = channels == 1 ? glm::vec3(value[voxel].x) : value[voxel];
        }
      });
      contents[blocks[b]].leaf = std::move(leaf);
    }
  };
  const std::size_t calls = (blocks.size() + together - 1) / together;
  for (std::size_t call = 0; call < calls; call += calls_per_report) {
    tbb::parallel_for(call, std::min(call + calls_per_report, calls), [&](std::size_t c) {
      evaluate_blocks(c * together, std::min((c + 1) * together, blocks.size()));
    });
    if (bad_block < blocks.size()) {
      const glm::ivec3 voxel = block_at(frame.blocks(), blocks[bad_block]) * kBlockEdge +
                               glm::ivec3(bad_voxel & 7, (bad_voxel >> 3) & 7, bad_voxel >> 6);
      const glm::vec3 p = frame.centre_of(voxel);
      refuse(material, rule, bad_value, format(" at (%g, %g, %g)", p.x, p.y, p.z));
    }
    within(double(std::min(call + calls_per_report, calls)) / double(calls));
  }

  Sum total;
  for (const Sum& sum : sums) {
    total.values += sum.values;
    total.count += sum.count;
    total.positive = total.positive || sum.positive;
  }
  Evaluated result{made_valid(rule, total.count ? glm::vec3(total.values / double(total.count)) : glm::vec3(0)),
                   total.positive};
  typename GridT::ValueType background;
  put(background, result.mean);
  grid = assemble<GridT>(frame, background, contents);
  return result;
}

}  // namespace

int varying_fields(const Material& material, const KnownRegion* known) {
  if (material.opaque) return 0;
  int count = 0;
  for (const auto member : {&Material::eta, &Material::sigma_s, &Material::sigma_a, &Material::g, &Material::emission}) {
    const FieldPtr& field = material.*member;
    if (field && !field->constant() && !(known && known->material.*member == field)) ++count;
  }
  return count;
}

void fill_coefficients(MediumVolume::Grids& medium, int r, const Material& material, const KnownRegion* known,
                       const StepProgress& within, const std::function<void()>& after_each) {
  Region& region = medium.regions[r];
  RegionGrids& fields = medium.fields[r];
  region.opaque = material.opaque;
  region.reflectance = material.reflectance;
  region.reflectance2 = material.reflectance2;
  region.checker_size = material.checker_size;
  if (material.opaque) return;

  const std::vector<int> blocks = varying_fields(material, known) > 0 ? blocks_near(medium, r) : std::vector<int>{};
  // Returns whether the coefficient is positive anywhere; `was_positive` is what the known region says of that.
  const auto fill = [&]<class Value, class GridPtr>(FieldPtr Material::*member, const Rule& rule,
                                                     GridPtr RegionGrids::*grid, Value Region::*constant,
                                                     bool Region::*varies, bool was_positive) {
    using GridT = typename GridPtr::element_type;
    const FieldPtr& field = material.*member;
    if (!field) return false;
    if (known && known->material.*member == field) {
      fields.*grid = known->fields.*grid;
      region.*constant = known->region.*constant;
      region.*varies = region.*varies || fields.*grid;
      return was_positive;
    }
    Evaluated found;
    if (const auto value = field->constant()) {
      if (!allows(rule, *value, sizeof(typename GridT::ValueType) / sizeof(float))) refuse(material, rule, *value, "");
      found = {made_valid(rule, *value), value->x > 0 || value->y > 0 || value->z > 0};
    } else {
      found = evaluate<GridT>(medium, r, material, rule, *field, blocks, within, fields.*grid);
      region.*varies = true;
      after_each();
    }
    if constexpr (std::is_same_v<Value, float>)
      region.*constant = found.mean.x;
    else
      region.*constant = found.mean;
    return found.positive;
  };
  const Region was = known ? known->region : Region{};
  fill(&Material::eta, kEta, &RegionGrids::eta, &Region::eta, &Region::graded_index, true);
  region.scatters = fill(&Material::sigma_s, kSigmaS, &RegionGrids::sigma_s, &Region::sigma_s, &Region::heterogeneous,
                         was.scatters);
  region.absorbs = fill(&Material::sigma_a, kSigmaA, &RegionGrids::sigma_a, &Region::sigma_a, &Region::heterogeneous,
                        was.absorbs);
  region.emits = fill(&Material::emission, kEmission, &RegionGrids::emission, &Region::emission,
                      &Region::heterogeneous, was.emits);
  fill(&Material::g, kMeanCosine, &RegionGrids::g, &Region::g, &Region::heterogeneous, true);
}

}  // namespace turbid
