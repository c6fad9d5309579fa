// SPDX-License-Identifier: Apache-2.0
// See error_measures.h. Sums are in double and in order, so a result does not depend on the number of threads.
#include "host/study/error_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace turbid {
namespace {

double ratio(double error, double size) {
  if (size > 0) return error / size;
  return error == 0 ? 0 : std::numeric_limits<double>::infinity();
}

/// Mean of all terms but the largest `trim` of them.
double trimmed_mean(std::vector<double>& terms, double trim) {
  const std::size_t kept = terms.size() - static_cast<std::size_t>(trim * static_cast<double>(terms.size()));
  if (kept < terms.size())
    std::nth_element(terms.begin(), terms.begin() + static_cast<std::ptrdiff_t>(kept), terms.end());
  double sum = 0;
  for (std::size_t i = 0; i < kept; ++i) sum += terms[i];
  return kept == 0 ? 0 : sum / static_cast<double>(kept);
}

}  // namespace

ErrorMeasures measure_errors(std::span<const float> a, std::span<const float> b, const MeasureSettings& settings) {
  if (a.size() != b.size()) throw std::invalid_argument("measure_errors: spans of different length");
  if (!(settings.trim >= 0 && settings.trim < 1)) throw std::invalid_argument("measure_errors: trim is not in [0, 1)");
  ErrorMeasures m;
  double absolute = 0, squared = 0, reference = 0, reference_squared = 0, largest = 0;
  const auto compared = [&](std::size_t i) { return std::isfinite(a[i]) && std::isfinite(b[i]); };
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!compared(i)) {
      ++m.not_finite;
      continue;
    }
    const double size = std::abs(double(b[i])), error = std::abs(double(a[i]) - double(b[i]));
    ++m.values;
    absolute += error;
    squared += error * error;
    reference += size;
    reference_squared += size * size;
    m.linf = std::max(m.linf, error);
    largest = std::max(largest, size);
  }
  m.peak = settings.peak > 0 ? settings.peak : largest;
  m.psnr = std::numeric_limits<double>::infinity();
  if (m.values == 0) return m;

  const double count = static_cast<double>(m.values), floor = settings.relative_floor * reference / count;
  m.mae = absolute / count;
  m.rmse = std::sqrt(squared / count);
  m.rel_l1 = ratio(absolute, reference);
  m.rel_l2 = std::sqrt(ratio(squared, reference_squared));
  if (squared > 0) m.psnr = 10 * std::log10(m.peak * m.peak * count / squared);
  m.epsilon = floor * floor;

  std::vector<double> terms;
  if (settings.trim > 0) terms.reserve(m.values);
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!compared(i)) continue;
    const double error = double(a[i]) - double(b[i]);
    const double term = ratio(error * error, double(b[i]) * double(b[i]) + m.epsilon);
    if (settings.trim > 0)
      terms.push_back(term);
    else
      sum += term;
  }
  m.relmse = settings.trim > 0 ? trimmed_mean(terms, settings.trim) : sum / count;
  return m;
}

double relative_l2(std::span<const float> a, std::span<const float> b) {
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = double(a[i]) - double(b[i]);
    difference += d * d;
    size += double(b[i]) * double(b[i]);
  }
  return difference == 0 ? 0 : std::sqrt(difference / size);
}

double root_relmse(std::span<const float> a, std::span<const float> b) {
  return std::sqrt(measure_errors(a, b).relmse);
}

const std::vector<Measure>& measures() {
  static const std::vector<Measure> all{
      {"mae", "mean |a - b|", {}},
      {"rmse", "root of the mean (a - b)^2", {}},
      {"linf", "largest |a - b|", {}},
      {"rel-l1", "sum |a - b| / sum |b|", 0.03},
      {"rel-l2", "root of sum (a - b)^2 / sum b^2", 0.03},
      {"relmse", "mean (a - b)^2 / (b^2 + epsilon)", 1e-3},
      {"psnr", "peak against rmse [dB]", 40.0, true},
      {"flip", "mean FLIP, what an eye sees in alternation", 0.02},
  };
  return all;
}

const Measure* find_measure(const std::string& name) {
  for (const Measure& measure : measures())
    if (measure.name == name) return &measure;
  return nullptr;
}

double Measure::of(const ErrorMeasures& m) const {
  if (name == "mae") return m.mae;
  if (name == "rmse") return m.rmse;
  if (name == "linf") return m.linf;
  if (name == "rel-l1") return m.rel_l1;
  if (name == "rel-l2") return m.rel_l2;
  if (name == "relmse") return m.relmse;
  if (name == "psnr") return m.psnr;
  return m.flip.value_or(std::numeric_limits<double>::quiet_NaN());
}

bool Measure::within(double value, double tolerance) const {
  return larger_is_better ? value >= tolerance : value <= tolerance;
}

}  // namespace turbid
