// SPDX-License-Identifier: Apache-2.0
// Texts for HTML and for the SVG inside it. Private to host/report.
#pragma once
#include <string>
#include <vector>

namespace turbid {

/// Safe as an element's content and as a quoted attribute. Control characters and what is no UTF-8 become U+FFFD.
std::string escaped(const std::string& text);

/// A stretch of text, raised or not.
struct TextRun {
  std::string text;
  bool raised = false;
};

/// Splits "W/mm^2" and "10^-3" at their exponents: '^' and an integer after it.
std::vector<TextRun> split_exponents(const std::string& text);

/// Escaped, exponents in <sup>.
std::string html_with_exponents(const std::string& text);

/// A number as number_text() gives it, its power of ten written out: "1.2e-05" is "1.2×10^-5"; a true minus sign.
std::string with_power_of_ten(const std::string& number);

/// Characters in it, counting U+FFFD's and letters alike.
std::size_t character_count(const std::string& text);

std::string base64(const std::vector<unsigned char>& bytes);

}  // namespace turbid
