// SPDX-License-Identifier: Apache-2.0
// A coefficient of the medium as a function of position: what a material's eta, sigma_s, sigma_a, g or emission is.
#pragma once
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace turbid {

/// Value of a coefficient at positions in scene units. Three colours (R, G, B); a grey or scalar coefficient has three
/// equal ones. Implementations are immutable: evaluate() may be called from several threads at once.
class Field {
 public:
  virtual ~Field() = default;
  /// The value if it is the same everywhere.
  virtual std::optional<glm::vec3> constant() const { return std::nullopt; }
  /// values[i] = field(positions[i]); the spans have one length.
  virtual void evaluate(std::span<const glm::vec3> positions, std::span<glm::vec3> values) const = 0;
  /// The factor on its values that its maker was given; none for fields that take no factor.
  virtual std::optional<glm::vec3> scale() const { return std::nullopt; }
  /// One line for `turbid check`, e.g. `expression "2 + noise(x,y,z)"`.
  virtual std::string describe() const = 0;
};
using FieldPtr = std::shared_ptr<const Field>;

FieldPtr constant_field(glm::vec3 value);
/// scale * field.
FieldPtr scaled_field(FieldPtr field, glm::vec3 scale);

}  // namespace turbid
