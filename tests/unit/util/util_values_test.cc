// Text, names, headers and outputs: limits and the values behind them.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "common/util/digest.h"
#include "common/util/error.h"
#include "common/util/format.h"
#include "common/util/free_disk.h"
#include "common/util/image_header.h"
#include "common/util/json_file.h"
#include "common/util/output_files.h"
#include "common/util/output_folder.h"
#include "common/util/quantile.h"
#include "common/util/suggestion.h"
#include "common/util/text_file.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class UtilValuesTest : public ::testing::Test {
 protected:
  std::vector<TextLine> Lines(const std::string& text, std::string* heading = nullptr) {
    return ReadTextLines(folder_.Write("text.txt", text), heading);
  }
  ScratchFolder folder_{"util_values"};
};

TEST_F(UtilValuesTest, LinesKeepTheirNumbersAndWords) {
  std::string heading;
  const std::vector<TextLine> lines =
      Lines("\xEF\xBB\xBF# no\n#  a b\n1 2\r\n\n \t\n# c d\n3\n", &heading);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].words, (Words{"1", "2"}));
  EXPECT_EQ(lines[0].number, 3);
  EXPECT_EQ(lines[1].words, (Words{"3"}));
  EXPECT_EQ(lines[1].number, 7);
  EXPECT_EQ(heading, "  a b");
  EXPECT_EQ(Lines("\xEF\xBB\xBF"
                  "5\n")[0]
                .words,
            (Words{"5"}));
}

TEST_F(UtilValuesTest, TheLongestLineAndTheLastOne) {
  const std::string longest(20000, '7');
  const std::vector<TextLine> lines = Lines(longest + "\n8\n");
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].words[0], longest);
  EXPECT_EQ(lines[1].number, 2);
  EXPECT_TRUE(Holds(ErrorOf([&] { Lines(longest + "7\n8\n"); }), "more than 20000 bytes"));
  const std::string blank(999999, '\n');
  EXPECT_EQ(Lines(blank + "9\n").at(0).number, 1000000);
  EXPECT_TRUE(Holds(ErrorOf([&] { Lines(blank + "\n9\n"); }), "more than 1000000 lines"));
}

TEST_F(UtilValuesTest, NumbersFromAWordOn) {
  const TextLine line = {4, {"P0:", "1.5", "-2e3"}};
  EXPECT_EQ(ParseNumbers("x", line, 1), (std::vector<double>{1.5, -2000}));
  EXPECT_EQ(ParseNumbers("x", line, 2), (std::vector<double>{-2000}));
  EXPECT_TRUE(Holds(ErrorOf([&] { ParseNumbers("x", line, 0); }), "x:4: 'P0:'"));
}

TEST(SuggestionValuesTest, DistancesAndHowMuchIsNear) {
  EXPECT_EQ(EditDistance("ab", "ba"), 1);
  EXPECT_EQ(EditDistance("kitten", "sitting"), 3);
  EXPECT_EQ(EditDistance("--Max_Diff", "max-diff"), 0);
  EXPECT_EQ(DidYouMean("abc", {"abd"}), "; did you mean 'abd'?");  // one of three letters
  EXPECT_EQ(DidYouMean("abc", {"axd"}), "");
  EXPECT_EQ(DidYouMean("abcd", {"abxy"}), "; did you mean 'abxy'?");  // two from four on
  EXPECT_EQ(DidYouMean("abcdefg", {"abcdxyz"}), "");                  // three from eight on
  EXPECT_EQ(DidYouMean("abcdefgh", {"abcdexyz"}), "; did you mean 'abcdexyz'?");
  EXPECT_EQ(DidYouMean("moda", {"modx", "mode"}), "; did you mean 'modx'?");  // the first of two
  EXPECT_EQ(DidYouMean("fpsrate", {"fps"}), "; did you mean 'fps'?");
  EXPECT_EQ(DidYouMean("fprate", {"fp"}), "");
  EXPECT_EQ(DidYouMean("zz.rate", {"player.rate"}), "; did you mean 'player.rate'?");
}

TEST_F(UtilValuesTest, AStampIsSizeAndTimeOfTheFile) {
  const std::string path = folder_.Write("a", "12345");
  const timespec times[2] = {{7, 8}, {1, 500000003}};
  ASSERT_EQ(utimensat(AT_FDCWD, path.c_str(), times, 0), 0);
  ASSERT_TRUE(StampOf(path));
  EXPECT_EQ(StampOf(path)->num_bytes, 5);
  EXPECT_EQ(StampOf(path)->mtime_ns, 1500000003);
  fs::create_symlink(path, folder_.PathOf("link"));
  EXPECT_TRUE(StampOf(folder_.PathOf("link"), true));
  EXPECT_FALSE(StampOf(folder_.PathOf("link"), false));
  EXPECT_FALSE(StampOf(folder_.path()));
}

/// What another program of ours would have left at the file.
bool MarkAs(const std::string& program, const std::string& path) {
  const FileStamp stamp = *StampOf(path);
  const std::string mark =
      std::to_string(stamp.num_bytes) + " " + std::to_string(stamp.mtime_ns) + " " + program;
  return setxattr(path.c_str(), "user.airdos.written", mark.data(), mark.size(), 0) == 0;
}

TEST_F(UtilValuesTest, WhatAnotherProgramWroteNeedsForce) {
  const std::string path = folder_.Write("a", "12345");
  if (!MarkAs("airdos-other", path)) GTEST_SKIP() << "no extended attributes here";
  EXPECT_EQ(WriterOf(path), "airdos-other");
  EXPECT_TRUE(Holds(ErrorOf([&] { CheckOutputFile(path, {}); }), "written by airdos-other"));
  EXPECT_NO_THROW(CheckOutputFile(path, {{}, true}));
  MarkWritten(path);
  EXPECT_NO_THROW(CheckOutputFile(path, {}));
  folder_.Write("a", "123456");
  EXPECT_EQ(WriterOf(path), "");
  EXPECT_TRUE(Holds(ErrorOf([&] { CheckOutputFile(path, {}); }), "not written by airdos"));
}

TEST_F(UtilValuesTest, OutputsThatChangedAreMarked) {
  const std::string same = folder_.Write("same", "1");
  const std::string changed = folder_.Write("changed", "1");
  const std::string made = folder_.PathOf("made");
  if (!MarkAs("x", same)) GTEST_SKIP() << "no extended attributes here";
  removexattr(same.c_str(), "user.airdos.written");
  {
    const OutputFiles files({same, changed, made, ""}, {{}, true});
    folder_.Write("changed", "12");
    folder_.Write("made", "1");
  }
  EXPECT_EQ(WriterOf(same), "");
  EXPECT_EQ(WriterOf(changed), program_invocation_short_name);
  EXPECT_EQ(WriterOf(made), program_invocation_short_name);
}

TEST_F(UtilValuesTest, AFileDeepInAnInputIsFoundUnderAnotherName) {
  const std::string deep = folder_.Write("input/a/b/c/file", "1");
  fs::create_hard_link(deep, folder_.PathOf("other"));
  EXPECT_TRUE(
      Holds(ErrorOf([&] { CheckNoInput(folder_.PathOf("other"), {folder_.PathOf("input")}); }),
            "is in the input folder"));
  EXPECT_NO_THROW(CheckNoInput(folder_.Write("free"), {folder_.PathOf("input")}));
}

constexpr auto kAll = [](const std::string&, const std::string&) { return true; };

TEST_F(UtilValuesTest, AFolderOfResultsFromRunToRun) {
  const std::string results = folder_.PathOf("results");
  {
    OutputFolder folder(results, {});
    folder_.Write("results/sub/one", "1");
    EXPECT_THROW(folder.Claim("sub/one", "g"), InputError);  // of somebody else
    fs::remove(results + "/sub/one");
    EXPECT_EQ(folder.Claim("sub/one", "g"), results + "/sub/one");
    folder_.Write("results/sub/one", "1");
    folder.Claim("two", "h");
    folder_.Write("results/two", "22");
    for (const char* name : {"../x", "/x", "", "a/./b", "a\nb"}) {
      EXPECT_TRUE(
          Holds(ErrorOf([&] { folder.Claim(name, "g"); }), "is not a valid name for a result"))
          << name;
    }
    EXPECT_TRUE(
        Holds(ErrorOf([&] { OutputFolder other(results, {}); }), "another run is writing here"));
  }
  {
    OutputFolder folder(results, {});
    EXPECT_TRUE(folder.IsListed("two"));
    folder.Claim("two", "h");
    folder_.Write("results/sub/.airdos_results", "");
    EXPECT_EQ(folder.RemoveEarlier([](const auto&, const auto& group) { return group == "x"; }), 0);
    EXPECT_EQ(folder.RemoveEarlier(kAll), 1);  // what was claimed stays
    EXPECT_FALSE(fs::exists(results + "/sub"));
    EXPECT_TRUE(fs::exists(results + "/two"));
    folder_.Write("results/two", "333");
  }
  folder_.Write("results/two", "4444");  // by the user
  OutputFolder folder(results, {});
  EXPECT_TRUE(
      Holds(ErrorOf([&] { folder.RemoveEarlier(kAll); }), "was changed since airdos wrote it"));
  EXPECT_TRUE(Holds(ErrorOf([&] { folder.RequireReplaceable({"two"}, kAll); }), "was changed"));
}

TEST_F(UtilValuesTest, WhatARunThatWasKilledAnnouncedIsReplaced) {
  folder_.Write("results/half", "1");
  folder_.Write("results/.airdos_results", "# head\n- - g half\n");
  OutputFolder folder(folder_.PathOf("results"), {});
  EXPECT_EQ(folder.RemoveEarlier(kAll), 1);
}

TEST(JsonValuesTest, WholeNumbersWithinBothLimits) {
  EXPECT_EQ(WholeNumber(-3, -3, 5), -3);
  EXPECT_EQ(WholeNumber(5.0, -3, 5), 5);
  for (const nlohmann::json& bad :
       {nlohmann::json(-4), nlohmann::json(6), nlohmann::json(2.5), nlohmann::json("3")})
    EXPECT_THROW(WholeNumber(bad, -3, 5), InputError) << bad;
}

// The example of FIPS 180-2.
TEST(TextValuesTest, WhatIsShownOfAFileIsPrintableAndShort) {
  EXPECT_EQ(Printable("a\x1b[31m\n\x7f z\xc3\xa4"), "a?[31m?? z\xc3\xa4");
  EXPECT_EQ(Shown(std::string(60, 'x')), std::string(60, 'x'));
  EXPECT_EQ(Shown(std::string(61, '\t')), std::string(60, '?') + "...");
}

TEST(FormatValuesTest, IsAsLongAsItsText) {
  EXPECT_EQ(Format("%s", ""), "");
  EXPECT_EQ(Format("%-6s|%6.2f %%|%+d", "ATE", 1.005, 7), "ATE   |  1.00 %|+7");
  const std::string word(1000, 'x');  // no buffer of a fixed length cuts it
  EXPECT_EQ(Format("%s%s.", word.c_str(), word.c_str()), word + word + ".");
  EXPECT_EQ(Format("%.*f", 3, 2.0 / 3), "0.667");
}

TEST(QuantileValuesTest, IsOnALineBetweenItsNeighbours) {
  EXPECT_EQ(Quantile({40, 10, 30, 20}, 0), 10);
  EXPECT_EQ(Quantile({40, 10, 30, 20}, 0.25), 17.5);  // h = 0.75
  EXPECT_EQ(Quantile({40, 10, 30, 20}, 0.5), 25);     // h = 1.5
  EXPECT_EQ(Quantile({40, 10, 30, 20}, 0.75), 32.5);  // h = 2.25
  EXPECT_EQ(Quantile({40, 10, 30, 20}, 1), 40);
  EXPECT_EQ(Quantile({5, 1, 3}, 0.5), 3);  // on a value
  EXPECT_EQ(Quantile({5, 1, 3}, 0.25), 2);
  // h = 98.01: a hundredth of the way from the 99th to the 100th value.
  std::vector<double> latencies(100, 4.0);
  latencies[7] = 104;
  EXPECT_NEAR(Quantile(latencies, 0.99), 5, 1e-12);
}

TEST(QuantileValuesTest, OfFewEqualAndInfiniteValues) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(Quantile({}, 0.5), 0);
  EXPECT_EQ(Quantile({-7}, 0.9), -7);
  EXPECT_EQ(Quantile({0.53, 0.53}, 0.05), 0.53);   // to the bit
  EXPECT_EQ(Quantile({1, 2, kInfinity}, 0.5), 2);  // not 0 * infinity
  EXPECT_EQ(Quantile({1, kInfinity, kInfinity, kInfinity}, 0.9), kInfinity);
}

TEST(DigestValuesTest, IsSha256) {
  Digest digest;
  digest.Add("a", 1);
  digest.Add("bc", 2);
  EXPECT_EQ(digest.Hex(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(FreeDiskValuesTest, AHundredthAtMostAHundredMegabytes) {
  EXPECT_EQ(DiskReserveBytes(1000000000), 10000000);
  EXPECT_EQ(DiskReserveBytes(10000000000), 100000000);
  EXPECT_EQ(DiskReserveBytes(1000000000000), 100000000);
}

/// A PNG of 7 x 5 px as far as its header goes.
std::optional<ImageHeader> PngHeader(int bits, int color_type) {
  std::vector<std::uint8_t> bytes = {0x89, 'P', 'N', 'G', 13, 10, 26, 10, 0, 0, 0, 13,
                                     'I',  'H', 'D', 'R', 0,  0,  0,  7,  0, 0, 0, 5};
  bytes.push_back(static_cast<std::uint8_t>(bits));
  bytes.push_back(static_cast<std::uint8_t>(color_type));
  bytes.resize(33);
  return ReadImageHeader(bytes.data(), bytes.size());
}

TEST(ImageHeaderValuesTest, KindsOfPng) {
  const std::vector<std::pair<int, int>> channels = {{0, 1}, {2, 3}, {3, 1}, {4, 2}, {6, 4}};
  for (const auto& [color_type, num_channels] : channels) {
    const std::optional<ImageHeader> header = PngHeader(16, color_type);
    ASSERT_TRUE(header);
    EXPECT_EQ(header->width, 7);
    EXPECT_EQ(header->height, 5);
    EXPECT_EQ(header->bits, 16);
    EXPECT_EQ(header->num_channels, num_channels) << color_type;
    EXPECT_EQ(header->is_palette, color_type == 3);
    EXPECT_EQ(header->has_alpha(), color_type >= 4);
  }
}

/// A JPEG of 300 x 200 px with an EXIF wish, in either order of bytes, as far as its frame goes.
std::vector<std::uint8_t> JpegHeader(bool is_big, int wish) {
  std::vector<std::uint8_t> tiff = {'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1, 1,
                                    18,  0,   3, 0,  0, 0, 1, 0, 0, 0, 0};
  tiff[19] = static_cast<std::uint8_t>(wish);
  if (!is_big) {
    tiff = {'I', 'I', 42, 0, 8, 0, 0, 0, 1, 0, 18, 1, 3, 0, 1, 0, 0, 0, 0, 0, 0, 0};
    tiff[18] = static_cast<std::uint8_t>(wish);
  }
  std::vector<std::uint8_t> file = {
      0xFF, 0xD8, 0xFF, 0xE1, 0, static_cast<std::uint8_t>(8 + tiff.size()),
      'E',  'x',  'i',  'f',  0, 0};
  file.insert(file.end(), tiff.begin(), tiff.end());
  file.insert(file.end(), {0xFF, 0xC0, 0, 17, 8, 0, 200, 1, 44, 3});
  file.insert(file.end(), 9, 0);
  return file;
}

TEST(ImageHeaderValuesTest, JpegAndItsWish) {
  for (const bool is_big : {true, false}) {
    for (const int wish : {1, 6, 8, 9, 0}) {
      const std::vector<std::uint8_t> file = JpegHeader(is_big, wish);
      const std::optional<ImageHeader> header = ReadImageHeader(file.data(), file.size());
      ASSERT_TRUE(header);
      EXPECT_EQ(header->width, 300);
      EXPECT_EQ(header->height, 200);
      EXPECT_EQ(header->num_channels, 3);
      EXPECT_EQ(header->bits, 8);
      EXPECT_EQ(header->orientation, wish >= 1 && wish <= 8 ? wish : 1) << is_big;
    }
  }
}

}  // namespace
}  // namespace airdos
