#ifndef AIRDOS_TESTS_FUZZ_FUZZ_INPUT_H_
#define AIRDOS_TESTS_FUZZ_FUZZ_INPUT_H_

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "processes/node/message/codec.h"
#include "tests/fuzz/fuzz_targets.h"

namespace airdos {

/// Takes an input apart; beyond its end everything is 0 and empty.
class FuzzInput {
 public:
  FuzzInput(const std::uint8_t* data, std::size_t size) : data_(data), end_(data + size) {}

  bool empty() const { return data_ == end_; }
  std::uint8_t U8() { return empty() ? std::uint8_t{0} : *data_++; }
  /// A length of two bytes, then as many bytes, or those that are left.
  FuzzBytes Block() {
    const std::size_t low = U8();
    const std::size_t announced = low + 256u * U8();
    const std::size_t size = std::min(announced, static_cast<std::size_t>(end_ - data_));
    FuzzBytes block(data_, data_ + size);
    data_ += size;
    return block;
  }

 private:
  const std::uint8_t* data_;
  const std::uint8_t* end_;
};

/// The other way round, for seeds.
class FuzzOutput {
 public:
  void U8(int value) { bytes_.push_back(static_cast<std::uint8_t>(value)); }
  void Block(const FuzzBytes& block) {
    const std::size_t size = std::min<std::size_t>(block.size(), 65535);
    U8(static_cast<int>(size % 256));
    U8(static_cast<int>(size / 256));
    bytes_.insert(bytes_.end(), block.begin(), block.begin() + static_cast<std::ptrdiff_t>(size));
  }
  void Block(const std::string& text) { Block(FuzzBytes(text.begin(), text.end())); }
  FuzzBytes Take() { return std::move(bytes_); }

 private:
  FuzzBytes bytes_;
};

/// A folder of this process in memory, where there is such a file system; removed at the end.
class FuzzFolder {
 public:
  static const std::string& Path() {
    static const FuzzFolder folder;
    return folder.path_;
  }
  static std::string Write(const std::string& name, const void* data, std::size_t size) {
    const std::string path = Path() + "/" + name;
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    return path;
  }
  /// Files with the names that stand in the lines of a text.
  static void MakeFiles(const std::string& folder, const FuzzBytes& text,
                        const std::string& content = "") {
    std::filesystem::create_directories(Path() + "/" + folder);
    constexpr std::size_t kMaxNames = 40;
    std::set<std::string> names;
    std::string name;
    const auto end_name = [&] {
      if (!name.empty() && name != "." && name != ".." && name.size() < 200) names.insert(name);
      name.clear();
    };
    for (const std::uint8_t c : text) {
      if (c == '\n') {
        end_name();
      } else if (c != '/' && c != 0) {
        name += static_cast<char>(c);
      }
      if (names.size() >= kMaxNames) break;
    }
    end_name();
    for (const std::string& one : names) {
      Write(std::string(folder).append("/").append(one), content.data(), content.size());
    }
  }

 private:
  FuzzFolder() {
    const bool has_memory = access("/dev/shm", W_OK) == 0;
    const std::filesystem::path parent =
        has_memory ? std::filesystem::path("/dev/shm") : std::filesystem::temp_directory_path();
    path_ = (parent / ("airdos_fuzz_" + std::to_string(getpid()))).string();
    std::filesystem::create_directories(path_);
  }
  ~FuzzFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string path_;
};

/// What must hold whatever the bytes are.
inline void FuzzCheck(bool holds, const std::string& what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz check failed: %s\n", what.c_str());
  std::abort();
}

/// A message without its fingerprint and header, which the targets put in front of what they are
/// given, so that changed bytes get beyond them.
template <class Message>
FuzzBytes BodyOf(const Message& message) {
  const FuzzBytes bytes = Encode(message);
  return FuzzBytes(bytes.begin() + 32, bytes.end());
}

}  // namespace airdos

#endif  // AIRDOS_TESTS_FUZZ_FUZZ_INPUT_H_
