// SPDX-License-Identifier: Apache-2.0
// See markup.h.
#include "host/report/markup.h"

#include <algorithm>
#include <cctype>

namespace turbid {
namespace {

constexpr const char* kReplacement = "\xEF\xBF\xBD";  // U+FFFD
constexpr const char* kMinus = "\xE2\x88\x92";        // U+2212
constexpr const char* kTimes = "\xC3\x97";            // U+00D7

/// Bytes of the UTF-8 character that begins at `at`; 0 if none does.
std::size_t character_size(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(at);
  const std::size_t size = first < 0x80   ? 1
                           : first < 0xC2 ? 0
                           : first < 0xE0 ? 2
                           : first < 0xF0 ? 3
                           : first < 0xF5 ? 4
                                          : 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((byte(at + i) & 0xC0) != 0x80) return 0;
  const unsigned second = byte(at + 1);  // overlong forms, surrogates, beyond U+10FFFF
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) || (first == 0xF0 && second < 0x90) ||
      (first == 0xF4 && second > 0x8F))
    return 0;
  return size;
}

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace

std::string escaped(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = character_size(text, at);
    const auto c = static_cast<unsigned char>(text[at]);
    if (size == 0 || c == 0x7F || (c < 0x20 && c != '\n' && c != '\t'))
      out += kReplacement;
    else if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\'')
      out += "&#39;";
    else
      out.append(text, at, size);
    at += std::max<std::size_t>(size, 1);
  }
  return out;
}

std::vector<TextRun> split_exponents(const std::string& text) {
  std::vector<TextRun> runs{{}};
  for (std::size_t at = 0; at < text.size();) {
    std::size_t end = at + 1;
    if (text[at] == '^') {
      if (end < text.size() && text[end] == '-') ++end;
      const std::size_t digits = end;
      while (end < text.size() && is_digit(text[end])) ++end;
      if (end > digits) {
        const bool negative = text[at + 1] == '-';
        runs.push_back({(negative ? kMinus : "") + text.substr(digits, end - digits), true});
        runs.push_back({});
        at = end;
        continue;
      }
      end = at + 1;
    }
    runs.back().text.append(text, at, end - at);
    at = end;
  }
  std::erase_if(runs, [](const TextRun& run) { return run.text.empty(); });
  return runs;
}

std::string html_with_exponents(const std::string& text) {
  std::string out;
  for (const TextRun& run : split_exponents(text))
    out += run.raised ? "<sup>" + escaped(run.text) + "</sup>" : escaped(run.text);
  return out;
}

std::string with_power_of_ten(const std::string& number) {
  const bool negative = number.starts_with('-');
  std::string text = negative ? number.substr(1) : number;
  const std::size_t e = text.find('e');
  if (e != std::string::npos && e > 0 && is_digit(text[e - 1])) {
    const std::string mantissa = text.substr(0, e);
    text = (mantissa == "1" ? "" : mantissa + kTimes) + "10^" + std::to_string(std::stoi(text.substr(e + 1)));
  }
  return (negative ? kMinus : "") + text;
}

std::size_t character_count(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string base64(const std::vector<unsigned char>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t left = std::min<std::size_t>(bytes.size() - at, 3);
    unsigned group = bytes[at] << 16;
    if (left > 1) group |= bytes[at + 1] << 8;
    if (left > 2) group |= bytes[at + 2];
    for (std::size_t i = 0; i < 4; ++i) text += i <= left ? kDigits[group >> (18 - 6 * i) & 63] : '=';
  }
  return text;
}

}  // namespace turbid
