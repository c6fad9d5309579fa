// SPDX-License-Identifier: Apache-2.0
// FNV-1a, 64 bits (Fowler, Noll, Vo): tells scenes and files apart; no protection against forgery.
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <vector>

#include "host/base/errors.h"
#include "host/scene/effective.h"

namespace turbid::scene {
namespace {

constexpr std::uint64_t kBasis = 0xcbf29ce484222325ull;

std::uint64_t fnv(std::uint64_t hash, const char* bytes, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) hash = (hash ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3ull;
  return hash;
}

std::string hex(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

}  // namespace

std::string hash_text(const std::string& text) {
  return hex(fnv(kBasis, text.data(), text.size()));
}

std::string hash_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> buffer(1 << 20);
  std::uint64_t hash = kBasis;
  if (!file) throw InputError(path + ": can't be opened");
  while (file) {
    file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    hash = fnv(hash, buffer.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw InputError(path + ": can't be read");
  return hex(hash);
}

}  // namespace turbid::scene
