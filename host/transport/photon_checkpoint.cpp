// SPDX-License-Identifier: Apache-2.0
// Layout: magic, fingerprint, counters, every vector with its length, and a hash of all that. In the machine's own byte order.
#include "host/transport/photon_checkpoint.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "host/base/atomic_file.h"
#include "host/base/errors.h"

namespace turbid {
namespace {

constexpr char kMagic[] = "turbid photon checkpoint 1\n";
constexpr std::size_t kMagicLength = sizeof kMagic - 1;

/// Calls visit(counter) and visit(vector) on every part of a state, in the file's order.
template <class State, class Visit>
void for_each_part(State& state, const Visit& visit) {
  for (auto* counter : {&state.finished, &state.batches, &state.colour, &state.followed}) visit(*counter);
  for (int c = 0; c < 3; ++c) {
    visit(state.unscattered[c]);
    visit(state.fluence[c].sum);
    visit(state.fluence[c].square);
    visit(state.tallies[c].sum);
    visit(state.tallies[c].square);
  }
  visit(state.device.voxels);
  visit(state.device.tallies);
  visit(state.device.ground);
  visit(state.device.ground_rays);
}

struct Writer {
  std::string* out;
  void bytes(const void* data, std::size_t size) const { out->append(static_cast<const char*>(data), size); }
  void operator()(std::uint64_t value) const { bytes(&value, sizeof value); }
  template <class T>
  void operator()(const std::vector<T>& values) const {
    (*this)(static_cast<std::uint64_t>(values.size()));
    bytes(values.data(), values.size() * sizeof(T));
  }
};

/// Reads what Writer wrote; `left` becomes short of nothing, or the file is damaged.
struct Reader {
  const std::string* path;
  const char** at;
  const char* end;
  void bytes(void* data, std::size_t size) const {
    if (static_cast<std::size_t>(end - *at) < size) throw InputError(*path + ": a damaged checkpoint; delete it to start anew");
    std::memcpy(data, *at, size);
    *at += size;
  }
  void operator()(std::uint64_t& value) const { bytes(&value, sizeof value); }
  template <class T>
  void operator()(std::vector<T>& values) const {
    std::uint64_t size = 0;
    (*this)(size);
    if (size != values.size()) throw InputError(*path + ": a damaged checkpoint; delete it to start anew");
    bytes(values.data(), values.size() * sizeof(T));
  }
};

}  // namespace

void write_checkpoint(const std::string& path, std::uint64_t fingerprint, const PhotonState& state) {
  std::string text(kMagic, kMagicLength);
  const Writer write{&text};
  write(fingerprint);
  for_each_part(state, write);
  write(turbid::fingerprint(0, text.data(), text.size()));
  write_file_atomically(path, text.data(), text.size());
}

bool read_checkpoint(const std::string& path, std::uint64_t fingerprint, PhotonState& state) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return false;
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (text.size() < kMagicLength + 2 * sizeof(std::uint64_t) || text.compare(0, kMagicLength, kMagic) != 0)
    throw InputError(path + ": not a checkpoint of the photon solver");
  std::uint64_t hash = 0;
  std::memcpy(&hash, text.data() + text.size() - sizeof hash, sizeof hash);
  if (hash != turbid::fingerprint(0, text.data(), text.size() - sizeof hash))
    throw InputError(path + ": a damaged checkpoint; delete it to start anew");
  const char* at = text.data() + kMagicLength;
  const Reader read{&path, &at, text.data() + text.size() - sizeof hash};
  std::uint64_t of_file = 0;
  read(of_file);
  if (of_file != fingerprint)
    throw InputError(path + ": a checkpoint of another scene, seed or settings; delete it to start anew");
  for_each_part(state, read);
  return true;
}

void remove_checkpoint(const std::string& path) {
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
}

}  // namespace turbid
