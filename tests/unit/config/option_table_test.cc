// One table: what it reads, and the file and the reference that it writes.
#include "common/config/option_table.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "common/config/option_pages.h"
#include "common/util/error.h"

namespace airdos {
namespace {

enum class Pace { kSlow, kFast };

struct Engine {
  bool is_on = true;
  int gears = 5;
  double least_m = 0.1;
  double largest_m = 60;
  double noise_left = 1e-4;
  double noise_right = 1e-4;
  Pace pace = Pace::kFast;
  std::string name;
  std::vector<std::string> friends = {"a", "b-c"};
  std::vector<int> steps = {3, 2};
};

OptionTable TableOf(Engine* engine) {
  OptionTable table("engine", "An engine, for tests.");
  table.AddSection("drive", "how it runs");
  table.Add("drive.on", &engine->is_on, "false: stands still");
  table.Add("drive.gears", &engine->gears, {1, 9}, "", "wheels that it has");
  table.AddChoice<Pace>("drive.pace", &engine->pace,
                        {{"slow", Pace::kSlow, "with care"}, {"fast", Pace::kFast, "without"}});
  table.AddSection("size");
  table.Add("size.least_m", &engine->least_m, {0, 100}, "m", "smallest");
  table.Add("size.largest_m", &engine->largest_m, {0, 100}, "m", "largest");
  table.RequireNotBelow("size.largest_m", "size.least_m");
  table.AddShared("size.noise", {&engine->noise_left, &engine->noise_right}, {0, 1e9}, "sigmas",
                  "of both sides, in as many words as it takes to fill more than the one line that "
                  "there is for them in the file");
  table.AddSection("rest");
  table.Add("rest.name", &engine->name, "as painted on it");
  table.Add("rest.friends", &engine->friends, "whom it knows");
  table.Add("rest.steps", &engine->steps, {1, 9}, "", "in this order");
  table.SetRenamed({{"drive.wheels", "drive.gears"}});
  return table;
}

constexpr char kFile[] =
    R"(# An engine, for tests. Every key must be here; an unknown key is an error.

drive:        # how it runs
  on: true    # false: stands still
  gears: 5    # wheels that it has
  pace: fast  # slow: with care
              # fast: without

size:
  least_m: 0.1     # m: smallest
  largest_m: 60.0  # m: largest
  noise: 1e-4      # sigmas: of both sides, in as many words as it takes to fill more than the one line that there is for them in
                   # the file

rest:
  name: ""        # as painted on it
  friends: a,b-c  # whom it knows
  steps: 3,2      # in this order
)";

std::string DefaultFile() {
  Engine engine;
  return ConfigFileText(TableOf(&engine));
}

Engine Read(const std::vector<std::string>& assignments) {
  ConfigReader config = ConfigReader::FromString(DefaultFile(), "engine.yaml");
  for (const std::string& text : assignments) config.Override(text);
  const Engine engine = ReadOptions<Engine>(&config);
  config.Finish();
  return engine;
}

std::string MessageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(OptionTableTest, WritesTheFileWithItsComments) { EXPECT_EQ(DefaultFile(), kFile); }

TEST(OptionTableTest, ReadsEachKind) {
  const Engine engine = Read({"drive.on=false", "drive.gears=7", "drive.pace=slow",
                              "size.least_m=0.2", "size.largest_m=1e1", "size.noise=3",
                              "rest.name=Big", "rest.friends=", "rest.steps=9"});
  EXPECT_FALSE(engine.is_on);
  EXPECT_EQ(engine.gears, 7);
  EXPECT_EQ(engine.pace, Pace::kSlow);
  EXPECT_EQ(engine.least_m, 0.2);
  EXPECT_EQ(engine.largest_m, 10);
  EXPECT_EQ(engine.noise_left, 3);
  EXPECT_EQ(engine.noise_right, 3);
  EXPECT_EQ(engine.name, "Big");
  EXPECT_TRUE(engine.friends.empty());
  EXPECT_EQ(engine.steps, std::vector<int>{9});
}

TEST(OptionTableTest, TheFileSaysTheDefaultsAndIsReadAgain) {
  Engine engine = Read({});
  EXPECT_EQ(ConfigFileText(TableOf(&engine)), kFile);
}

TEST(OptionTableTest, NumbersAreWrittenAsTheyAreReadAgain) {
  Engine engine;
  const OptionTable table = TableOf(&engine);
  const std::pair<double, std::string> texts[] = {
      {0, "0.0"},           {100, "100.0"},  {0.35, "0.35"},       {1e9, "1e+9"},
      {1.5e-10, "1.5e-10"}, {1e10, "1e+10"}, {120000, "120000.0"}, {1.0 / 3, "0.3333333333333333"}};
  for (const auto& [number, text] : texts) {
    engine.noise_left = engine.noise_right = number;
    EXPECT_EQ(table.options()[5].value(), text);
    EXPECT_EQ(std::stod(text), number);
  }
}

TEST(OptionTableTest, WhatIsWrongIsNamed) {
  const auto message = [](const std::string& assignment) {
    return MessageOf([&] { Read({assignment}); });
  };
  EXPECT_EQ(message("drive.gears=10"),
            "engine.yaml: key 'drive.gears' with value '10': must lie between 1 and 9");
  EXPECT_EQ(message("drive.pace=fats"),
            "engine.yaml: key 'drive.pace' with value 'fats': must be one of slow, fast; did you "
            "mean 'fast'?");
  EXPECT_EQ(message("size.largest_m=0.05"),
            "engine.yaml: key 'size.largest_m' with value '0.05': must not be below size.least_m, "
            "0.1");
  EXPECT_EQ(message("size.least_m=60.0"), "no error") << "as large is not below";
  for (const std::string steps : {"0", "10", "3,10", "3;2", "2.5"}) {
    EXPECT_EQ(message("rest.steps=" + steps),
              "engine.yaml: key 'rest.steps' with value '" + steps +
                  "': must be whole numbers between 1 and 9, separated by commas");
  }
  EXPECT_EQ(message("rest.steps="),
            "engine.yaml: key 'rest.steps' with value '': must name at least one number");
}

TEST(OptionTableTest, ARenamedKeyIsAnsweredWithTheNewOne) {
  Engine engine;
  const RenamedKeys renamed = TableOf(&engine).renamed();
  EXPECT_EQ(
      MessageOf([&] { ConfigReader::FromString("drive:\n  wheels: 4\n", "old.yaml", renamed); }),
      "old.yaml: key 'drive.wheels' is called 'drive.gears' now");
  ConfigReader config = ConfigReader::FromString(kFile, "engine.yaml", renamed);
  EXPECT_EQ(MessageOf([&] { config.Override("drive.wheels=4"); }),
            "engine.yaml: key 'drive.wheels' is called 'drive.gears' now");
  EXPECT_EQ(MessageOf([&] { config.Override("drive.wheel=4"); }).substr(0, 78),
            "engine.yaml: key 'drive.wheel' with value '4': there is no such key");
}

TEST(OptionTableTest, TheReferenceSaysWhatIsAllowed) {
  const OptionPages pages = PagesOf<Engine>();
  EXPECT_EQ(pages.config_name, "engine");
  EXPECT_EQ(pages.default_file, kFile);
  EXPECT_EQ(pages.reference, R"(drive.on: true  (true or false)
    false: stands still
drive.gears: 5  (1 to 9)
    wheels that it has
drive.pace: fast  (slow, fast)
    slow: with care
    fast: without
size.least_m: 0.1  (0 to 100)
    m: smallest
size.largest_m: 60.0  (0 to 100)
    m: largest
size.noise: 1e-4  (0 to 1e+09)
    sigmas: of both sides, in as many words as it takes to fill more than the one line that there is
    for them in the file
rest.name: ""  (text)
    as painted on it
rest.friends: a,b-c  (words separated by commas)
    whom it knows
rest.steps: 3,2  (1 to 9, separated by commas)
    in this order
)");
}

}  // namespace
}  // namespace airdos
