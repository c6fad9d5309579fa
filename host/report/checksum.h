// SPDX-License-Identifier: Apache-2.0
// A number for the bits of a result, to compare runs with: FNV-1a (Fowler, Noll, Vo), 64 bits.
#pragma once
#include <cstdint>
#include <cstdio>
#include <string>
#include <type_traits>
#include <vector>

namespace turbid {

/// 16 hex digits over the arrays' bytes, one after the other.
template <class... T>
std::string checksum(const std::vector<T>&... arrays) {
  static_assert((std::is_trivially_copyable_v<T> && ...));
  std::uint64_t hash = 0xcbf29ce484222325ull;
  const auto add = [&hash](const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3ull;
  };
  (add(arrays.data(), arrays.size() * sizeof(T)), ...);
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace turbid
