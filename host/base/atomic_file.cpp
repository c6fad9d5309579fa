// SPDX-License-Identifier: Apache-2.0
// Atomic files by POSIX calls, whose every result is looked at: a full disk may show only in fsync or close.
#include "host/base/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "host/base/errors.h"

namespace turbid {
namespace {

[[noreturn]] void fail(const std::string& path, int error) {
  throw InputError(path + ": cannot be written: " + std::generic_category().message(error));
}

/// 0, or the errno of what failed.
int write_and_close(int file, const char* bytes, std::size_t size) {
  int error = 0;
  while (size > 0 && error == 0) {
    const ssize_t written = ::write(file, bytes, size);
    if (written < 0) {
      if (errno != EINTR) error = errno;
      continue;
    }
    bytes += written;
    size -= static_cast<std::size_t>(written);
  }
  // Some file systems cannot sync; that alone is no failure.
  if (error == 0 && ::fsync(file) != 0 && errno != EINVAL && errno != ENOTSUP) error = errno;
  if (::close(file) != 0 && error == 0) error = errno;
  return error;
}

/// A written file that is not yet where it belongs; destroyed before it is moved there, it is gone.
class PendingFile {
 public:
  PendingFile(const std::string& path, const char* bytes, std::size_t size) : path_(path) {
    static std::atomic<unsigned> count{0};
    const std::filesystem::path target(path);
    const std::filesystem::path folder = target.parent_path();
    if (!target.has_filename()) fail(path, EISDIR);
    std::error_code error;
    if (!folder.empty()) std::filesystem::create_directories(folder, error);
    if (error) fail(path, error.value());
    if (std::filesystem::is_directory(target, error)) fail(path, EISDIR);

    temporary_ = (folder / (".turbid-" + std::to_string(::getpid()) + "-" + std::to_string(count++) + ".tmp")).string();
    const int file = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0) fail(path, errno);
    if (const int failed = write_and_close(file, bytes, size)) {
      ::unlink(temporary_.c_str());
      fail(path, failed);
    }
  }
  PendingFile(PendingFile&& other) noexcept
      : path_(std::move(other.path_)), temporary_(std::exchange(other.temporary_, {})) {}
  ~PendingFile() {
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
  }

  void move_into_place() {
    if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, errno);
    temporary_.clear();
  }

 private:
  std::string path_, temporary_;
};

}  // namespace

void write_file_atomically(const std::string& path, const void* bytes, std::size_t size) {
  PendingFile(path, static_cast<const char*>(bytes), size).move_into_place();
}

void write_files_atomically(const std::vector<std::pair<std::string, std::string>>& files) {
  std::vector<PendingFile> pending;
  for (const auto& [path, bytes] : files) pending.emplace_back(path, bytes.data(), bytes.size());
  for (PendingFile& file : pending) file.move_into_place();
}

}  // namespace turbid
