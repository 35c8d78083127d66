#ifndef AIRDOS_TESTS_SUPPORT_FOLDER_TEST_H_
#define AIRDOS_TESTS_SUPPORT_FOLDER_TEST_H_

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/scratch_folder.h"

namespace airdos {

/// A test that writes and reads files in a folder of its own.
class FolderTest : public ::testing::Test {
 protected:
  explicit FolderTest(const std::string& name) : scratch_(name), folder_(scratch_.path()) {}

  std::string Path(const std::string& name) const { return scratch_.PathOf(name); }
  std::string Write(const std::string& name, const std::string& text) const {
    return scratch_.Write(name, text);
  }
  std::string TextOf(const std::string& name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  const ScratchFolder scratch_;
  const std::filesystem::path folder_;
};

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_FOLDER_TEST_H_
