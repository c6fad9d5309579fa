// SPDX-License-Identifier: Apache-2.0
// rasterise(): OSMesa decides which triangle is nearest in each pixel; the hit itself is computed here, in double, by
// intersecting the pixel-centre ray with that triangle. (Positions interpolated by GL were up to a 400th of a pixel off
// the ray, and at silhouettes insides showed that no ray sees.)
#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>

#include "host/base/errors.h"
#include "host/base/parallel.h"
#include "host/raster/osmesa_context.h"
#include "host/raster/pixel_hit.h"
#include "host/raster/raster.h"

namespace turbid {
namespace {

constexpr int kTile = 2048;               ///< pixels; with its depth a tile takes 32 MiB
constexpr std::size_t kBatch = 1u << 17;  ///< triangles per draw call, 6 MiB of corners

/// Triangle `number` of all meshes, counted from 1 across them in their order.
struct TriangleTable {
  std::span<const RasterMesh> meshes;
  std::vector<std::uint32_t> first;  ///< number of each mesh's first triangle, and one past the last mesh's last

  explicit TriangleTable(std::span<const RasterMesh> all) : meshes(all), first{1} {
    for (const RasterMesh& m : all) {
      const std::size_t next = first.back() + m.mesh->triangles.size();
      if (next > 0xffffffffu) throw InputError("the meshes have more than 4294967294 triangles together");
      first.push_back(static_cast<std::uint32_t>(next));
    }
  }
  Corners corners(std::uint32_t number) const {
    const std::size_t m = mesh_of(number);
    return corners_of(*meshes[m].mesh, number - first[m]);
  }
  std::size_t mesh_of(std::uint32_t number) const {
    return static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), number) - first.begin()) - 1;
  }
};

/// Part of the picture: pixel (x, y) of the tile is pixel (left + x, top + y) of the picture.
struct Tile {
  int left, top, width, height;
};

/// world -> GL clip coordinates of the tile, y downwards (row 0 at the top), z reversed: w at the near plane, 0 at far.
glm::dmat4 tile_transform(const RasterView& view, const Tile& tile) {
  const double sx = double(view.width) / tile.width, sy = double(view.height) / tile.height;
  const double ox = (view.width - 2.0 * tile.left) / tile.width - 1.0;
  const double oy = (view.height - 2.0 * tile.top) / tile.height - 1.0;
  glm::dmat4 m(0.0);  // columns
  m[0][0] = sx, m[3][0] = ox;
  m[1][1] = -sy, m[3][1] = oy;
  m[2][2] = -0.5, m[3][2] = 0.5;
  m[3][3] = 1;
  return m * glm::dmat4(view.projection) * glm::dmat4(view.view);
}

void draw_all(NumberTarget& target, const TriangleTable& table, const glm::dmat4& to_clip) {
  std::vector<glm::vec4> points, corners;
  for (std::size_t i = 0; i < table.meshes.size(); ++i) {
    const TriangleMesh& mesh = *table.meshes[i].mesh;
    points.resize(mesh.positions.size());
    parallel_ranges(static_cast<int>(points.size()), [&](int first, int last) {
      for (int p = first; p < last; ++p) points[p] = glm::vec4(to_clip * glm::dvec4(mesh.positions[p], 1.0));
    });
    for (std::size_t begin = 0; begin < mesh.triangles.size(); begin += kBatch) {
      const std::size_t end = std::min(begin + kBatch, mesh.triangles.size());
      corners.resize(3 * (end - begin));
      parallel_ranges(static_cast<int>(end - begin), [&](int first, int last) {
        for (int t = first; t < last; ++t)
          for (int k = 0; k < 3; ++k) corners[3 * static_cast<std::size_t>(t) + k] = points[mesh.triangles[begin + t][k]];
      });
      target.draw({&corners[0].x, 4 * corners.size()}, table.first[i] + static_cast<std::uint32_t>(begin));
    }
  }
}

/// What is seen through one pixel, given the tile's triangle numbers.
class PixelResolver {
 public:
  PixelResolver(const TriangleTable& table, const Tile& tile, const std::vector<std::uint32_t>& numbers)
      : table_(table), tile_(tile), numbers_(numbers) {}

  /// `number`: in the pixel's place on entry, of the triangle that was really hit on return (0: none).
  Hit resolve(const Ray& ray, int x, int y, std::uint32_t& number) const {
    const Corners corners = table_.corners(number);
    if (const auto hit = intersect(ray, corners)) return *hit;
    // GL moves corners by up to 1/256 pixel and fills pixels whose centre lies that much outside the triangle.
    const Hit edge = nearest_edge(ray, corners);
    if (faces(ray, corners)) return edge;
    // An inside that peeps out at a silhouette would make an eye outside look as if it were inside: what is really
    // there is a triangle that a pixel next to this one sees, or nothing.
    std::optional<Hit> best;
    std::uint32_t best_number = 0;
    bool beside_nothing = false;
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, tile_.height - 1); ++j)
      for (int i = std::max(x - 1, 0); i <= std::min(x + 1, tile_.width - 1); ++i) {
        const std::uint32_t other = numbers_[std::size_t(j) * tile_.width + i];
        if (other == 0) beside_nothing = true;
        if (other == 0 || other == number) continue;
        const auto hit = intersect(ray, table_.corners(other));
        if (!hit || (best && best->distance <= hit->distance)) continue;
        best = hit;
        best_number = other;
      }
    if (best)
      number = best_number;
    else if (beside_nothing)
      number = 0;
    return best.value_or(edge);
  }

 private:
  const TriangleTable& table_;
  const Tile& tile_;
  const std::vector<std::uint32_t>& numbers_;
};

void store_hit(RasterImage& image, std::size_t at, const Ray& ray, const Hit& hit, const RasterMesh& entry,
               std::size_t triangle) {
  const TriangleMesh& mesh = *entry.mesh;
  const Corners p = corners_of(mesh, triangle);
  const glm::dvec3 face = glm::cross(p[1] - p[0], p[2] - p[0]);
  glm::dvec3 normal(0);
  if (mesh.corner_normals.size() == 3 * mesh.triangles.size())
    for (int k = 0; k < 3; ++k) normal += hit.barycentric[k] * glm::dvec3(mesh.corner_normals[3 * triangle + k]);
  // Opposite corner normals can cancel on a needle; the face's own normal is what is left.
  if (!(glm::length(normal) > 1e-6)) normal = face;

  image.id[at] = entry.id;
  image.position[at] = ray.origin + hit.distance * ray.direction;
  image.normal[at] = glm::normalize(normal);
  image.front[at] = faces(ray, p) ? 1 : 0;
}

/// A context and its target, kept for the next picture of this thread: a driver compiles shaders anew for each context, which
/// takes longer than drawing.
class Canvas {
 public:
  /// With room for tiles of this size, up to `largest()`.
  NumberTarget& target(int width, int height) {
    if (!target_ || width > width_ || height > height_) {
      width_ = std::max(width, width_);
      height_ = std::max(height, height_);
      target_.reset();
      target_ = std::make_unique<NumberTarget>(context_, width_, height_);
    }
    return *target_;
  }
  int largest() const { return std::min(kTile, NumberTarget::largest_size(context_)); }

 private:
  OsmesaContext context_;
  std::unique_ptr<NumberTarget> target_;
  int width_ = 0, height_ = 0;
};

Canvas& canvas_of_thread() {
  thread_local std::unique_ptr<Canvas> canvas;
  if (!canvas) canvas = std::make_unique<Canvas>();
  return *canvas;
}

}  // namespace

RasterImage rasterise(std::span<const RasterMesh> meshes, const RasterView& view) {
  if (view.width <= 0 || view.height <= 0) throw InputError("a picture needs at least one pixel each way");
  const std::size_t pixels = std::size_t(view.width) * std::size_t(view.height);
  RasterImage image;
  image.width = view.width;
  image.height = view.height;
  image.id.assign(pixels, -1);
  image.position.assign(pixels, glm::vec3(0));
  image.normal.assign(pixels, glm::vec3(0));
  image.front.assign(pixels, 0);

  const TriangleTable table(meshes);
  const PixelRays rays(view);
  Canvas& canvas = canvas_of_thread();
  const int limit = canvas.largest();
  NumberTarget& target = canvas.target(std::min(limit, view.width), std::min(limit, view.height));
  std::vector<std::uint32_t> numbers;
  for (int top = 0; top < view.height; top += limit)
    for (int left = 0; left < view.width; left += limit) {
      const Tile tile{left, top, std::min(limit, view.width - left), std::min(limit, view.height - top)};
      target.clear(tile.width, tile.height);
      draw_all(target, table, tile_transform(view, tile));
      numbers.resize(std::size_t(tile.width) * std::size_t(tile.height));
      target.read(tile.width, tile.height, numbers.data());
      const PixelResolver resolver(table, tile, numbers);
      parallel_ranges(tile.height, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
          for (int x = 0; x < tile.width; ++x) {
            std::uint32_t number = numbers[std::size_t(y) * tile.width + x];
            if (number == 0) continue;
            const Ray ray = rays.at(left + x, top + y);
            const Hit hit = resolver.resolve(ray, x, y, number);
            if (number == 0) continue;
            const std::size_t mesh = table.mesh_of(number);
            store_hit(image, std::size_t(top + y) * view.width + (left + x), ray, hit, meshes[mesh],
                      number - table.first[mesh]);
          }
      });
    }
  return image;
}

}  // namespace turbid
