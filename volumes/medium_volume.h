// SPDX-License-Identifier: Apache-2.0
// The voxelised medium: OpenVDB grids of every region's signed distance and coefficients, and who owns each voxel.
//
// Region 0 is the ambient (the domain's own material, or vacuum); regions 1..n are the bodies in the order of the scene
// file. Where bodies overlap the one that stands LATER in the scene wins: a body nested in another is listed after it.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "volumes/field.h"
#include "volumes/frame.h"
#include "volumes/solid.h"

namespace turbid {

struct Material {
  std::string name;
  FieldPtr eta;        ///< refractive index [1], >= 1
  FieldPtr sigma_s;    ///< scattering coefficient [1/scene unit], >= 0
  FieldPtr sigma_a;    ///< absorption coefficient [1/scene unit], >= 0
  FieldPtr g;          ///< mean cosine of the phase function [1], in (-1, 1)
  FieldPtr emission;   ///< isotropically emitted power per volume [W/scene unit^3], >= 0
  bool opaque = false;             ///< an opaque Lambertian surface instead of a medium: the fields above are unused
  glm::vec3 reflectance{0.5f};     ///< diffuse reflectance of an opaque surface, in [0, 1]
  glm::vec3 reflectance2{0.5f};    ///< second colour of its checkerboard
  float checker_size = 0.0f;       ///< edge of a checkerboard square [scene units]; 0: plain
};

/// How a body's surface refracts.
enum class SurfaceKind {
  sharp,   ///< Snell and Fresnel at the zero crossing of the signed distance
  smooth,  ///< Bernabei et al. III-A: the index is blurred by a Gaussian and rays bend in its gradient; no reflection
};

struct Body {
  std::string name;
  Solid solid;
  int material = 0;                        ///< index into MediumDescription::materials
  SurfaceKind surface = SurfaceKind::sharp;
};

struct MediumDescription {
  GridFrame frame;
  std::array<FaceBoundary, 6> faces{};     ///< -x, +x, -y, +y, -z, +z
  std::vector<Material> materials;
  int ambient_material = -1;               ///< -1: vacuum (eta 1, nothing scatters or absorbs)
  std::vector<Body> bodies;
  float smoothing_voxels = 1.0f;           ///< standard deviation of the Gaussian of smooth surfaces [voxels]
};

/// What is known of a region without looking at its voxels.
struct Region {
  std::string name;
  bool opaque = false;
  glm::vec3 reflectance{0}, reflectance2{0};
  float checker_size = 0;
  bool smooth_surface = false;             ///< belongs to the group of regions whose index is blurred together
  bool graded_index = false;               ///< eta varies: use IndexGrid; else `eta` holds
  bool heterogeneous = false;              ///< sigma_s, sigma_a, g or emission varies: use the grids; else constants hold
  bool scatters = false;                   ///< sigma_s > 0 somewhere
  bool emits = false;
  bool absorbs = false;
  float eta = 1.0f;                        ///< constant index (mean over the region if graded)
  glm::vec3 sigma_s{0}, sigma_a{0}, emission{0};
  float g = 0.0f;

  /// Diffuse light is solved for here.
  bool participates() const { return !opaque && (scatters || emits); }
};

/// Coefficients of one region at one voxel centre.
struct Coefficients {
  glm::vec3 sigma_s{0}, sigma_a{0}, emission{0};
  float g = 0;
};

class MediumVolume {
 public:
  const GridFrame& frame() const;
  const std::array<FaceBoundary, 6>& faces() const;
  int region_count() const;                                     ///< 1 + number of bodies
  const Region& region(int r) const;
  float smoothing_voxels() const;

  /// Voxels of the box [lower, lower + size), x fastest; voxels outside the domain repeat its nearest voxel
  /// (wrap around on periodic axes is the caller's affair).
  /// Signed distance of body r >= 1 in VOXELS, clamped to +-band(); < 0 inside.
  void read_signed_distance(int r, glm::ivec3 lower, glm::ivec3 size, std::span<float> out) const;
  /// Refractive index as region r sees it (its own field, or the blurred one of the smooth group). eta >= 1.
  void read_eta(int r, glm::ivec3 lower, glm::ivec3 size, std::span<float> out) const;
  /// Region r's own coefficients, also at voxels that other regions own (so that interpolation up to r's surface needs
  /// no values of its neighbours). Valid within two voxels of the blocks that r touches.
  void read_coefficients(int r, glm::ivec3 lower, glm::ivec3 size, std::span<Coefficients> out) const;
  /// Region that owns each voxel, decided at its centre; 0 outside the domain is NOT repeated: -1 there.
  void read_owner(glm::ivec3 lower, glm::ivec3 size, std::span<int> out) const;

  static constexpr float band() { return 4.0f; }

  /// Named grids (`eta`, `sigma_s`, `sigma_a`, `g`, `emission`, `occupancy`, `signed_distance`, `region`) as an OpenVDB
  /// file with transform and unit metadata. Throws InputError if the file can't be written.
  void write_vdb(const std::string& path, const std::string& unit) const;

  struct Grids;                                                  ///< the OpenVDB side, defined in medium_volume.cpp's folder
  explicit MediumVolume(std::unique_ptr<Grids>);
  MediumVolume(MediumVolume&&) noexcept;
  MediumVolume& operator=(MediumVolume&&) noexcept;
  ~MediumVolume();
  const Grids& grids() const { return *grids_; }

 private:
  std::unique_ptr<Grids> grids_;
};

/// Turns meshes and materials into voxels. `progress(fraction)` may throw to stop. Throws InputError where a coefficient
/// is negative, NaN or infinite, or eta < 1, naming the material, the coefficient and the position.
MediumVolume voxelise(const MediumDescription&, const std::function<void(double)>& progress = {});

/// The same for a description whose bodies and frame are those of `known`, which `medium` was made from, and whose
/// materials may differ: distances and owners are shared with `medium`, and so is every coefficient whose Field is the
/// same object. Equal to voxelise() in every bit.
MediumVolume revoxelise(const MediumVolume& medium, const MediumDescription& known, const MediumDescription&,
                        const std::function<void(double)>& progress = {});

}  // namespace turbid
