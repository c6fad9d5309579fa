// SPDX-License-Identifier: Apache-2.0
// Fields given as text in x, y, z and r, computed by muParser: see procedural.h.
#include <muParser.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "host/base/errors.h"
#include "volumes/noise.h"
#include "volumes/procedural.h"

namespace turbid {
namespace {

/// The colours of a field often ask for the same noise one after the other, point by point: each thread keeps what it
/// found last.
double fbm(double x, double y, double z, double octaves) {
  struct Known {
    std::array<double, 4> at{std::numeric_limits<double>::quiet_NaN()};
    double value = 0;
  };
  constexpr std::size_t kKnown = 8192;
  thread_local std::vector<Known> known(kKnown);
  const std::array<double, 4> at{x, y, z, octaves};
  std::uint64_t hash = 0;
  for (double number : at)
    hash = (hash ^ std::bit_cast<std::uint64_t>(number)) * 0x9e3779b97f4a7c15ull, hash ^= hash >> 29;
  Known& one = known[hash % kKnown];
  if (one.at != at) one = {at, fractal_noise(x, y, z, octaves >= 1.0 ? static_cast<int>(std::min(octaves, 16.0)) : 1)};
  return one.value;
}
double clamp(double v, double lo, double hi) {
  return std::min(std::max(v, lo), hi);
}
double mix(double a, double b, double t) {
  return a + t * (b - a);
}
double step(double edge, double v) {
  return v < edge ? 0.0 : 1.0;
}
double smoothstep(double lo, double hi, double v) {
  if (lo == hi) return step(lo, v);  // lo > hi falls from 1 to 0
  const double t = clamp((v - lo) / (hi - lo), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

[[noreturn]] void fail(const std::string& text, int character, const std::string& message) {
  throw InputError("expression \"" + text + "\"" +
                   (character > 0 ? ", character " + std::to_string(character) : std::string()) + ": " + message);
}

/// One text and the variables that it reads. muParser writes to itself while evaluating, so every evaluate() makes its
/// own.
class Program {
 public:
  explicit Program(const std::string& text) : text_(text) {
    if (text.find_first_not_of(" \t\r\n") == std::string::npos) fail(text, 0, "is empty");
    refuse_assignment();
    try {
      for (auto [name, at] : {std::pair{"x", &x_}, {"y", &y_}, {"z", &z_}, {"r", &r_}}) parser_.DefineVar(name, at);
      parser_.DefineConst("pi", 3.14159265358979323846);
      parser_.DefineFun("noise", gradient_noise);
      parser_.DefineFun("fbm", fbm);
      parser_.DefineFun("clamp", clamp);
      parser_.DefineFun("mix", mix);
      parser_.DefineFun("step", step);
      parser_.DefineFun("smoothstep", smoothstep);
      parser_.SetExpr(text);
      parser_.Eval();
      constant_ = parser_.GetUsedVar().empty();
      if (parser_.GetNumResults() != 1)
        fail(text, 0, "gives " + std::to_string(parser_.GetNumResults()) + " values: expected one");
    } catch (const mu::Parser::exception_type& error) {
      refuse(error);
    }
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  double operator()(glm::vec3 at) {
    x_ = at.x;
    y_ = at.y;
    z_ = at.z;
    r_ = std::sqrt(x_ * x_ + y_ * y_ + z_ * z_);
    try {
      return parser_.Eval();
    } catch (const mu::Parser::exception_type& error) {
      refuse(error);
    }
  }
  bool constant() const { return constant_; }

 private:
  // muParser would let `x = 1` overwrite the position.
  void refuse_assignment() const {
    for (std::size_t i = 0; i < text_.size(); ++i) {
      if (text_[i] != '=') continue;
      const bool comparison = (i > 0 && std::string("<>!=").find(text_[i - 1]) != std::string::npos) ||
                              (i + 1 < text_.size() && text_[i + 1] == '=');
      if (!comparison)
        fail(text_, static_cast<int>(i) + 1, "\"=\" would assign a value: expected a comparison, \"==\"");
    }
  }
  [[noreturn]] void refuse(const mu::Parser::exception_type& error) const {
    std::string message = error.GetMsg();
    while (!message.empty() && (message.back() == '.' || message.back() == ' ')) message.pop_back();
    const int position = error.GetPos();
    const bool inside = position >= 0 && position <= static_cast<int>(text_.size());
    fail(text_, inside ? position + 1 : 0,
         message +
             "; it may use x, y, z, r, pi, noise(x,y,z), fbm(x,y,z,octaves), clamp, mix, step, smoothstep and sin, "
             "sqrt, exp, min, max, ...");
  }

  std::string text_;
  double x_ = 0, y_ = 0, z_ = 0, r_ = 0;
  bool constant_ = false;
  mu::Parser parser_;
};

class ExpressionField final : public Field {
 public:
  explicit ExpressionField(const std::array<std::string, 3>& texts) : texts_(texts) {
    bool constant = true;
    glm::vec3 value{0};
    for (int c = 0; c < 3; ++c) {
      Program program(texts_[c]);  // so that mistakes are found when the scene is read
      constant = constant && program.constant();
      value[c] = static_cast<float>(program(glm::vec3(0)));
    }
    if (constant) constant_ = value;
  }

  std::optional<glm::vec3> constant() const override { return constant_; }

  void evaluate(std::span<const glm::vec3> positions, std::span<glm::vec3> values) const override {
    Program programs[3]{Program(texts_[0]), Program(texts_[1]), Program(texts_[2])};
    constexpr std::size_t kPiece = 512;  // all colours of few points before the next: see fbm
    for (std::size_t begin = 0; begin < positions.size(); begin += kPiece) {
      const std::size_t end = std::min(begin + kPiece, positions.size());
      for (int c = 0; c < 3; ++c) {
        const int same = c > 0 && texts_[c] == texts_[0] ? 0 : c == 2 && texts_[2] == texts_[1] ? 1 : c;
        for (std::size_t i = begin; i < end; ++i) {
          values[i][c] = same != c ? values[i][same] : static_cast<float>(programs[c](positions[i]));
        }
      }
    }
  }

  std::string describe() const override {
    if (texts_[0] == texts_[1] && texts_[0] == texts_[2]) return "expression \"" + texts_[0] + "\"";
    return "expressions \"" + texts_[0] + "\", \"" + texts_[1] + "\", \"" + texts_[2] + "\"";
  }

 private:
  std::array<std::string, 3> texts_;
  std::optional<glm::vec3> constant_;
};

}  // namespace

FieldPtr expression_field(const std::array<std::string, 3>& texts) {
  return std::make_shared<ExpressionField>(texts);
}

FieldPtr expression_field(const std::string& text) {
  return expression_field(std::array<std::string, 3>{text, text, text});
}

}  // namespace turbid
