// SPDX-License-Identifier: BSD-3-Clause
#include <repel/sealed/key.hpp>

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include <repel/base/setup_error.hpp>

namespace repel::sealed {
namespace {

constexpr std::size_t digits = 2 * sizeof(Key);
using KeyText = std::array<char, digits + 1>;  // and a line feed

constexpr const char* advice = "; allowed: a file that teleop key FILE wrote";

/// A file while it is open.
class File {
 public:
  File(const std::string& path, int flags) : number_(::open(path.c_str(), flags, 0600)) {}
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] int number() const noexcept { return number_; }

 private:
  int number_;
};

[[noreturn]] void fail(const std::string& what, const std::string& path) {
  const std::string why = std::generic_category().message(errno);
  throw SetupError(what + ": " + why, path);
}

}  // namespace

void make_key(const std::string& path) {
  if (sodium_init() < 0) throw SetupError("libsodium finds no random numbers");
  Key key;
  randombytes_buf(key.data(), key.size());
  KeyText text;
  sodium_bin2hex(text.data(), text.size(), key.data(), key.size());
  text.back() = '\n';
  const File file(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC);
  if (file.number() < 0 && errno == EEXIST) {
    throw SetupError("is there already, and a key is not overwritten; allowed: a new name", path);
  }
  if (file.number() < 0) fail("the key cannot be written", path);
  // Whatever the umask takes away.
  const bool is_written =
      ::fchmod(file.number(), 0600) == 0 &&
      ::write(file.number(), text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      ::fsync(file.number()) == 0;
  sodium_memzero(key.data(), key.size());
  sodium_memzero(text.data(), text.size());
  if (is_written) return;
  const int error = errno;
  (void)::unlink(path.c_str());
  errno = error;
  fail("the key cannot be written", path);
}

Key load_key(const std::string& path) {
  const File file(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat status {};
  if (file.number() < 0 || ::fstat(file.number(), &status) != 0) {
    fail("the key cannot be read", path);
  }
  if (!S_ISREG(status.st_mode)) throw SetupError("is no file" + std::string(advice), path);
  if ((status.st_mode & 077U) != 0) {
    throw SetupError(
        "others than its owner may use this key; allowed: mode 0600, as after chmod "
        "600 FILE; if others may have read it, make a new one: teleop key FILE",
        path);
  }
  // One more than there may be.
  std::array<char, sizeof(KeyText) + 1> text;
  const ssize_t size = ::read(file.number(), text.data(), text.size());
  if (size < 0) fail("the key cannot be read", path);
  const auto count = static_cast<std::size_t>(size);
  const bool has_size = count == digits || (count == digits + 1 && text[digits] == '\n');
  Key key;
  std::size_t read = 0;
  if (!has_size ||
      sodium_hex2bin(key.data(), key.size(), text.data(), digits, nullptr, &read, nullptr) != 0 ||
      read != key.size()) {
    throw SetupError("is no key of " + std::to_string(digits) + " hexadecimal digits" + advice,
                     path);
  }
  sodium_memzero(text.data(), text.size());
  return key;
}

}  // namespace repel::sealed
