// SPDX-License-Identifier: Apache-2.0
// The fields that need no library: a constant, and the named index profiles of gradient-index optics.
#include "volumes/procedural.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace turbid {
namespace {

std::string number(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string numbers(glm::vec3 v) {
  return std::string("[") + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + "]";
}

class ConstantField final : public Field {
 public:
  explicit ConstantField(glm::vec3 value) : value_(value) {}
  std::optional<glm::vec3> constant() const override { return value_; }
  void evaluate(std::span<const glm::vec3>, std::span<glm::vec3> values) const override {
    std::fill(values.begin(), values.end(), value_);
  }
  std::string describe() const override {
    return value_.x == value_.y && value_.x == value_.z ? number(value_.x) : numbers(value_);
  }

 private:
  glm::vec3 value_;
};

class ScaledField final : public Field {
 public:
  ScaledField(FieldPtr field, glm::vec3 factor) : field_(std::move(field)), factor_(factor) {}
  std::optional<glm::vec3> constant() const override {
    const auto value = field_->constant();
    return value ? std::optional(factor_ * *value) : std::nullopt;
  }
  void evaluate(std::span<const glm::vec3> positions, std::span<glm::vec3> values) const override {
    field_->evaluate(positions, values);
    if (factor_ == glm::vec3(1)) return;
    for (glm::vec3& value : values) value *= factor_;
  }
  std::optional<glm::vec3> scale() const override { return factor_; }
  std::string describe() const override {
    if (factor_ == glm::vec3(1)) return field_->describe();
    char text[64];
    std::snprintf(text, sizeof text, "(%g, %g, %g) times ", factor_.x, factor_.y, factor_.z);
    return text + field_->describe();
  }

 private:
  FieldPtr field_;
  glm::vec3 factor_;
};

/// A scalar formula of the position; `Index` is a callable vec3 -> float.
template <class Index>
class IndexField final : public Field {
 public:
  IndexField(std::string text, Index index) : text_(std::move(text)), index_(std::move(index)) {}
  void evaluate(std::span<const glm::vec3> positions, std::span<glm::vec3> values) const override {
    for (std::size_t i = 0; i < positions.size(); ++i) values[i] = glm::vec3(index_(positions[i]));
  }
  std::string describe() const override { return text_; }

 private:
  std::string text_;
  Index index_;
};

template <class Index>
FieldPtr index_field(std::string text, Index index) {
  return std::make_shared<IndexField<Index>>(std::move(text), std::move(index));
}

}  // namespace

FieldPtr constant_field(glm::vec3 value) {
  return std::make_shared<ConstantField>(value);
}

FieldPtr scaled_field(FieldPtr field, glm::vec3 scale) {
  return std::make_shared<ScaledField>(std::move(field), scale);
}

FieldPtr luneburg_index(glm::vec3 centre, float radius, float eta_surface) {
  return index_field(std::string("luneburg about ") + numbers(centre) + ", radius " + number(radius) + ", index " +
                         number(eta_surface) + " at its surface",
                     [=](glm::vec3 x) {
                       const float q = glm::distance(x, centre) / radius;
                       return eta_surface * std::sqrt(std::max(2.0f - q * q, 0.1f));
                     });
}

FieldPtr fisheye_index(glm::vec3 centre, float radius, float eta_centre) {
  return index_field(std::string("fisheye about ") + numbers(centre) + ", radius " + number(radius) + ", index " +
                         number(eta_centre) + " at its centre",
                     [=](glm::vec3 x) {
                       const float q = glm::distance(x, centre) / radius;
                       return eta_centre / (1.0f + q * q);
                     });
}

FieldPtr rod_index(glm::vec3 centre, glm::vec3 axis, float eta_axis, float alpha) {
  const glm::vec3 along = glm::normalize(axis);
  return index_field(std::string("rod through ") + numbers(centre) + " along " + numbers(along) + ", index " +
                         number(eta_axis) + " on its axis, alpha " + number(alpha),
                     [=](glm::vec3 x) {
                       const glm::vec3 d = x - centre;
                       const glm::vec3 across = d - glm::dot(d, along) * along;
                       const float q = alpha * alpha * glm::dot(across, across);
                       return std::max(eta_axis * std::sqrt(std::max(1.0f - q, 0.0f)), 1.0f);
                     });
}

FieldPtr linear_index(glm::vec3 centre, float eta_centre, glm::vec3 gradient) {
  return index_field(std::string("linear about ") + numbers(centre) + ", index " + number(eta_centre) + ", gradient " +
                         numbers(gradient),
                     [=](glm::vec3 x) { return std::max(eta_centre + glm::dot(gradient, x - centre), 1.0f); });
}

}  // namespace turbid
