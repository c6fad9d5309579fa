// SPDX-License-Identifier: Apache-2.0
// Texels of parallel light, clipped in the map's own plane: a plane's points are linear in the texel's coordinates, so
// that each face of the domain is a straight line there.
#include "host/transport/parallel_texels.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace turbid {
namespace {

constexpr double kLeastShare = 1e-9;  // a smaller part of a texel carries nothing worth a ray
constexpr double kLeastCosine = 1e-4;
constexpr double kSlack = 0.01;  // hits so far outside the domain are still in it [voxels]
constexpr double kFlat = 0.1;    // how far neighbouring hits may lie off a flat surface [texels]

bool closed(const Faces& faces, int face) {
  return faces[static_cast<std::size_t>(face)] != FaceBoundary::open;
}

/// Convex polygon of few corners.
struct Polygon {
  std::array<glm::dvec2, 12> corner;
  int corners = 0;
  void add(glm::dvec2 p) { corner[static_cast<std::size_t>(corners++)] = p; }
  glm::dvec2 at(int i) const { return corner[static_cast<std::size_t>(i)]; }
};

/// The side of a polygon where dot(slope, q) <= limit.
Polygon clipped(const Polygon& polygon, glm::dvec2 slope, double limit) {
  Polygon result;
  for (int i = 0; i < polygon.corners; ++i) {
    const glm::dvec2 a = polygon.at(i), b = polygon.at((i + 1) % polygon.corners);
    const double da = glm::dot(slope, a) - limit, db = glm::dot(slope, b) - limit;
    if (da <= 0) result.add(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) result.add(a + (da / (da - db)) * (b - a));
  }
  return result;
}

/// The points of a plane by the map's coordinates (column, row): A + column B + row C.
struct PlaneMap {
  glm::dvec3 a, b, c;
  glm::dvec3 at(glm::dvec2 q) const { return a + q.x * b + q.y * c; }
};

class ParallelMap {
 public:
  ParallelMap(const RasterView& view, glm::vec3 direction) : direction_(direction) {
    const glm::dmat4 to_clip = glm::dmat4(view.projection) * glm::dmat4(view.view);
    const glm::dmat4 to_world = glm::inverse(to_clip);
    const auto world = [&](double column, double row) {
      return glm::dvec3(to_world * glm::dvec4(2 * column / view.width - 1, 1 - 2 * row / view.height, 0, 1));
    };
    first_ = world(0, 0);
    column_ = world(1, 0) - first_;
    row_ = world(0, 1) - first_;
    // The light's own direction up to the rounding of the view's matrices; columns of light must be the raster's.
    direction_ = glm::normalize(glm::dvec3(to_world * glm::dvec4(0, 0, 1, 0)));
    if (glm::dot(direction_, glm::dvec3(direction)) < 0) direction_ = -direction_;
    edge_ = std::sqrt(glm::length(glm::cross(column_, row_)));
  }
  glm::dvec3 direction() const { return direction_; }
  double texel_edge() const { return edge_; }
  PlaneMap on_plane(glm::dvec3 point, glm::dvec3 normal) const {
    const auto along = [&](glm::dvec3 p) {
      return p - glm::dot(normal, p) / glm::dot(normal, direction_) * direction_;
    };
    return {point + along(first_ - point), along(column_), along(row_)};
  }
  glm::dvec2 coordinates(glm::dvec3 point) const {
    const glm::dvec3 p = point - first_;
    return {glm::dot(p, column_) / glm::dot(column_, column_), glm::dot(p, row_) / glm::dot(row_, row_)};
  }

 private:
  glm::dvec3 direction_, first_, column_, row_;
  double edge_;
};

struct Part {
  double share = 0;
  glm::dvec3 centre{0};
};

/// The part of the texel whose least corner is q that a plane shows within the wanted faces of the domain.
Part part_within(const PlaneMap& plane, glm::dvec2 q, const GridFrame& frame, const std::array<bool, 6>& wanted) {
  Polygon polygon;
  for (const glm::dvec2 corner : {q, q + glm::dvec2(1, 0), q + glm::dvec2(1, 1), q + glm::dvec2(0, 1)})
    polygon.add(corner);
  for (int face = 0; face < 6; ++face) {
    if (!wanted[static_cast<std::size_t>(face)]) continue;
    const int axis = face / 2;
    const double sign = face % 2 ? 1 : -1, bound = face % 2 ? frame.upper()[axis] : frame.origin[axis];
    polygon = clipped(polygon, sign * glm::dvec2(plane.b[axis], plane.c[axis]), sign * (bound - plane.a[axis]));
  }
  double area = 0;
  glm::dvec2 moment(0);
  for (int i = 1; i + 1 < polygon.corners; ++i) {
    const glm::dvec2 u = polygon.at(i) - polygon.at(0), v = polygon.at(i + 1) - polygon.at(0);
    const double triangle = 0.5 * std::abs(u.x * v.y - u.y * v.x);
    area += triangle;
    moment += triangle / 3.0 * (u + v);
  }
  if (area < kLeastShare) return {};
  return {std::min(area, 1.0), plane.at(polygon.at(0) + moment / area)};
}

glm::dvec3 outward(int face) {
  glm::dvec3 normal(0);
  normal[face / 2] = face % 2 ? 1 : -1;
  return normal;
}

/// What bodies show to parallel light near the domain's mirror and periodic faces.
class BodyTexels {
 public:
  BodyTexels(const RasterImage& image, const ParallelMap& map, const GridFrame& frame, const Faces& faces)
      : image_(image), map_(map), frame_(frame), faces_(faces) {
    for (int face = 0; face < 6; ++face) closed_[static_cast<std::size_t>(face)] = closed(faces, face);
  }

  void add_part_of(int x, int y, std::vector<BodyPart>& out) const {
    const glm::dvec2 corner(x, y);
    if (seen_inside(x, y)) {
      const std::size_t i = index(x, y);
      if (const double cosine = std::abs(glm::dot(normal(i), map_.direction())); cosine > kLeastCosine) {
        const Part part = part_within(plane(i), corner, frame_, closed_);
        if (part.share < 1 - kLeastShare && flat(x, y)) {
          if (part.share > 0) out.push_back({i, i, part.share, glm::vec3(part.centre)});
          return;
        }
      }
      out.push_back({i, i, 1.0, image_.position[i]});
      return;
    }
    // Its centre lies beyond a face, but perhaps not all of it: the surface goes on as its neighbour within sees it.
    static constexpr int kNeighbours[8][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    for (const auto& step : kNeighbours) {
      const int nx = x + step[0], ny = y + step[1];
      if (!seen_inside(nx, ny)) continue;
      const std::size_t j = index(nx, ny);
      if (std::abs(glm::dot(normal(j), map_.direction())) <= kLeastCosine) continue;
      const PlaneMap surface = plane(j);
      if (!beyond_closed_face(surface.at(corner + 0.5)) || !flat(nx, ny)) continue;
      const Part part = part_within(surface, corner, frame_, closed_);
      if (part.share > 0) out.push_back({index(x, y), j, part.share, glm::vec3(part.centre)});
      return;
    }
  }

 private:
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * image_.width + x; }
  glm::dvec3 normal(std::size_t i) const { return image_.normal[i]; }
  PlaneMap plane(std::size_t i) const { return map_.on_plane(image_.position[i], normal(i)); }

  bool seen_inside(int x, int y) const {
    if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return false;
    const std::size_t i = index(x, y);
    if (image_.id[i] < 0 || !image_.front[i]) return false;
    const double slack = kSlack * frame_.voxel_size;
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2;
      const double sign = face % 2 ? 1 : -1, bound = face % 2 ? frame_.upper()[axis] : frame_.origin[axis];
      const double out = sign * (image_.position[i][axis] - bound);
      if (out > slack) return false;
      // A body that ends on such a face goes on in the domain's next copy: its side there is not seen.
      if (closed(faces_, face) && out > -slack && glm::dot(normal(i), outward(face)) > 0.99) return false;
    }
    return true;
  }
  bool beyond_closed_face(glm::dvec3 p) const {
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2;
      if (closed(faces_, face) && (face % 2 ? p[axis] > frame_.upper()[axis] : p[axis] < frame_.origin[axis]))
        return true;
    }
    return false;
  }
  /// Whether what is seen around a texel of the same body lies in one plane.
  bool flat(int x, int y) const {
    const std::size_t i = index(x, y);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (!seen_inside(x + dx, y + dy)) continue;
        const std::size_t j = index(x + dx, y + dy);
        if (image_.id[j] != image_.id[i]) continue;
        const glm::dvec3 away = glm::dvec3(image_.position[j]) - glm::dvec3(image_.position[i]);
        if (std::abs(glm::dot(normal(i), away)) > kFlat * map_.texel_edge()) return false;
      }
    }
    return true;
  }

  const RasterImage& image_;
  const ParallelMap& map_;
  const GridFrame& frame_;
  const Faces& faces_;
  std::array<bool, 6> closed_{};
};

}  // namespace

double lit_area(glm::vec3 direction, const GridFrame& frame, const Faces& faces) {
  const glm::dvec3 unit = glm::normalize(glm::dvec3(direction)), size(frame.upper() - frame.origin);
  double sum = 0;
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    const double facing = -glm::dot(unit, outward(face));
    if (!closed(faces, face) && facing > 0) sum += facing * size[(axis + 1) % 3] * size[(axis + 2) % 3];
  }
  return sum;
}

std::vector<FacePart> parts_on_faces(const RasterView& view, glm::vec3 direction, const GridFrame& frame,
                                     const Faces& faces) {
  const ParallelMap map(view, direction);
  std::vector<FacePart> result;
  for (int face = 0; face < 6; ++face) {
    if (closed(faces, face) || -glm::dot(map.direction(), outward(face)) < kLeastCosine) continue;
    const glm::dvec3 low(frame.origin), high(frame.upper());
    glm::dvec2 first(1e30), last(-1e30);
    for (int i = 0; i < 8; ++i) {
      glm::dvec3 corner(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
      corner[face / 2] = face % 2 ? high[face / 2] : low[face / 2];
      first = glm::min(first, map.coordinates(corner));
      last = glm::max(last, map.coordinates(corner));
    }
    std::array<bool, 6> sides;
    for (int side = 0; side < 6; ++side) sides[static_cast<std::size_t>(side)] = side / 2 != face / 2;
    const PlaneMap plane = map.on_plane(face % 2 ? high : low, outward(face));
    for (int y = static_cast<int>(std::floor(first.y)); y < last.y; ++y) {
      for (int x = static_cast<int>(std::floor(first.x)); x < last.x; ++x) {
        const Part part = part_within(plane, glm::dvec2(x, y), frame, sides);
        if (part.share <= 0) continue;
        const bool on_map = x >= 0 && y >= 0 && x < view.width && y < view.height;
        const std::ptrdiff_t texel = on_map ? static_cast<std::ptrdiff_t>(y) * view.width + x : -1;
        result.push_back({texel, part.share, glm::vec3(part.centre)});
      }
    }
  }
  return result;
}

std::vector<BodyPart> parts_on_bodies(const RasterImage& image, const RasterView& view, glm::vec3 direction,
                                      const GridFrame& frame, const Faces& faces) {
  const ParallelMap map(view, direction);
  const BodyTexels texels(image, map, frame, faces);
  std::vector<BodyPart> result;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) texels.add_part_of(x, y, result);
  }
  return result;
}

}  // namespace turbid
