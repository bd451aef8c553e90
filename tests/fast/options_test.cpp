#include "collarmesh/options.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "collarmesh/error.h"

namespace collarmesh::options_test {
namespace {

using Kind = Option::Kind;

const Option& row(const std::string& name) {
  for (const Option& option : option_table())
    if (option.name == name) return option;
  throw std::runtime_error("no option " + name);
}

/// Returns a word, or a number within the range of an option that is not its default.
std::string some_text(const Option& option) {
  switch (option.kind()) {
    case Kind::choice: return option.words.back();
    case Kind::sizes: return "7=0.25";
    case Kind::text:
    case Kind::texts: return "a file";
    default: break;
  }
  const double middle = std::isfinite(option.high) ? 0.5 * (option.low + option.high) : option.low + 3;
  for (const double number : {std::ceil(middle), middle, option.high, option.low}) {
    RunOptions options;
    std::string text = fmt::format("{}", number);
    if (option.read(text, options) && option.get(options) != option.get({})) return text;
  }
  throw std::runtime_error("only one value for " + option.name);
}

// An option may have a row for each of several commands, but no command may have two rows of it. `programs`
// stands for callers with functions for several commands, so it may have several rows.
TEST(OptionTable, ANameIsThereOnceForEachCommand) {
  std::set<std::pair<std::string, unsigned>> known;
  for (const Option& option : option_table())
    for (unsigned command = 1; command != 0; command <<= 1U)
      if (command != Option::programs && (option.commands & command) != 0) {
        EXPECT_TRUE(known.emplace(option.name, command).second) << option.name;
      }
  for (const Option& option : option_table()) EXPECT_NE(option.commands, 0U) << option.name;
}

TEST(OptionTable, EveryOptionIsExplained) {
  for (const Option& option : option_table()) {
    EXPECT_FALSE(option.help.empty()) << option.name;
    EXPECT_FALSE(option.group.empty()) << option.name;
    EXPECT_NE(option.help.back(), '.') << option.name;
    EXPECT_EQ(option.value_name.empty(), option.kind() == Kind::flag) << option.name;
  }
}

// Each row has its own member: reading one option changes no other, except a second row of the same name.
TEST(OptionTable, ReadingChangesOneOption) {
  for (const Option& option : option_table()) {
    RunOptions options;
    if (option.kind() == Kind::flag)
      option.set(options, !std::get<bool>(option.get({})));
    else
      ASSERT_TRUE(option.read(some_text(option), options)) << option.name << ' ' << some_text(option);
    for (const Option& other : option_table())
      EXPECT_EQ(other.get(options) != other.get({}), other.name == option.name)
          << option.name << ' ' << other.name;
  }
}

TEST(OptionTable, KeysAreNamesWithUnderscores) {
  for (const Option& option : option_table()) {
    const std::string key = option.key();
    ASSERT_EQ(key.size(), option.name.size());
    for (std::size_t i = 0; i < key.size(); ++i)
      EXPECT_EQ(key[i], option.name[i] == '-' ? '_' : option.name[i]);
  }
}

// A flag is set by its name alone, so no text fits it. Defaults that are shown are read as the default.
TEST(OptionTable, DefaultsAndDescriptionsOfValuesFit) {
  for (const Option& option : option_table()) {
    SCOPED_TRACE(option.name);
    const std::string fitting = option.fitting(), shown = option.default_value();
    for (const std::string& word : option.words)
      if (option.kind() == Kind::choice) {
        EXPECT_NE(fitting.find(word), std::string::npos) << fitting;
      }
    if (option.kind() == Kind::sizes) {
      EXPECT_NE(fitting.find("TAG=LENGTH"), std::string::npos);
    }
    RunOptions options;
    if (option.kind() == Kind::flag) {
      EXPECT_FALSE(option.read("on", options));
      if (!option.words.empty() && option.default_text.empty()) {
        EXPECT_EQ(shown, option.words[std::get<bool>(option.get({})) ? 0 : 1]);
      }
    } else if (option.default_text.empty() && !shown.empty()) {
      EXPECT_TRUE(option.read(shown, options)) << shown;
      EXPECT_EQ(option.get(options), option.get({})) << shown;
    }
  }
  EXPECT_NE(row("max-memory").fitting().find("500M"), std::string::npos);
}

TEST(OptionTable, DefaultsAreValid) { EXPECT_NO_THROW(validate({})); }

TEST(OptionTable, RangesHoldForTextAndForValues) {
  for (const Option& option : option_table()) {
    if (option.kind() != Kind::number) continue;
    const auto judged = [&](double number) {
      RunOptions options;
      option.set(options, number);
      bool valid = true;
      try {
        validate(options);
      } catch (const OptionError& error) {
        valid = false;
        EXPECT_NE(std::string(error.what()).find(option.name), std::string::npos) << error.what();
      }
      const bool read = option.read(std::to_string(number), options);
      EXPECT_TRUE(read == valid || OptionValue(number) == option.get({})) << option.name << ' ' << number;
      return valid;
    };
    EXPECT_FALSE(judged(-1)) << option.name;
    EXPECT_FALSE(judged(std::nan(""))) << option.name;
    EXPECT_FALSE(judged(INFINITY)) << option.name;
    if (option.low > 0) {
      EXPECT_FALSE(judged(0.9 * option.low)) << option.name;
    }
    if (option.high < 1e6) {
      EXPECT_FALSE(judged(option.high + 1)) << option.name;
      EXPECT_TRUE(judged(option.high)) << option.name;
    }
  }
}

TEST(OptionTable, WhatFitsIsTold) {
  EXPECT_EQ(row("size").fitting(), "a length >= 0 in input units");
  EXPECT_EQ(row("collar-angle").fitting(), "an angle from 100 to 175 degrees");
  EXPECT_EQ(row("thin-angle").fitting(), "an angle from 0.1 to 30 degrees, or 0");
  EXPECT_EQ(row("weld").fitting(), "a number from 0 to 0.1 (relative to the diagonal)");
  EXPECT_EQ(row("improve").fitting(), "one of 0, 1, 2, 3");
  EXPECT_EQ(row("repair").fitting(), "one of auto, none, wrap");
  EXPECT_EQ(row("partitions").fitting(), "a whole number from 1 to 1000000");
  EXPECT_EQ(row("threads").fitting(), "a whole number from 0 to 1024");
  EXPECT_EQ(row("radius-edge").fitting(), "a ratio of at least 1");
}

TEST(OptionTable, WordsAreThoseOfTheEnumerations) {
  RunOptions options;
  EXPECT_TRUE(row("repair").read("none", options) && row("coarsen").read("off", options));
  EXPECT_TRUE(row("collar-creation").read("up-front", options) && row("overlap").read("region", options));
  EXPECT_EQ(options.repair.mode, RepairMode::off);
  EXPECT_FALSE(options.coarsen);
  EXPECT_EQ(options.mesh.collar_creation, CollarCreation::up_front);
  EXPECT_EQ(options.overlap, SolidOverlap::region);
  EXPECT_TRUE(row("repair").read("wrap", options));
  EXPECT_EQ(options.repair.mode, RepairMode::wrap);
  EXPECT_EQ(std::get<std::string>(row("repair").get(options)), "wrap");
  EXPECT_FALSE(row("repair").read("maybe", options));
}

TEST(OptionTable, RepeatedOptionsAreAdded) {
  RunOptions options;
  for (const char* text : {"7=0.25", "8=1", "7=0.5"}) EXPECT_TRUE(row("patch-size").read(text, options));
  EXPECT_EQ(options.mesh.patch_size, (std::map<Tag, double>{{7, 0.5}, {8, 1}}));
  for (const char* text : {"a.json", "a.html"}) EXPECT_TRUE(row("report").read(text, options));
  EXPECT_EQ(options.reports, (std::vector<std::string>{"a.json", "a.html"}));
}

TEST(OptionTable, ContradictionsAreRefused) {
  EXPECT_THROW(validate({{.mesh = {.size = 1, .size_min = 2}}}), OptionError);
  EXPECT_THROW(validate({{.mesh = {.region_size = {{3, -1}}}}}), OptionError);
  EXPECT_NO_THROW(validate({{.mesh = {.bounds = {.thin_angle = 0}}, .coarsen = false}}));
  EXPECT_THROW(validate({{.mesh = {.bounds = {.thin_angle = 0}}}}), OptionError);
  EXPECT_NO_THROW(validate({{.periodic = {{"x", "1=2:rotation,z,90"}}}}));
  EXPECT_THROW(validate({{.split = {.keep_apart = true}, .periodic = {{"x"}}}}), OptionError);
  EXPECT_THROW(validate({{.coarsen = false, .periodic = {{"x"}}}}), OptionError);
  const LayerOptions layers{.walls = {"all"}};
  EXPECT_NO_THROW(validate({{.layers = layers}}));
  EXPECT_THROW(validate({{.split = {.keep_apart = true}, .layers = layers}}), OptionError);
  EXPECT_THROW(validate({{.layers = layers, .periodic = {{"x"}}}}), OptionError);
  EXPECT_THROW(validate({{.dimension = 2, .layers = layers}}), OptionError);
  EXPECT_THROW(validate({{.layers = {.tets = true}}}), OptionError);
}

TEST(Profile, OfThePaperSetsOthersAndRefusesContradictions) {
  RunOptions options;
  ASSERT_TRUE(row("profile").read("paper", options));
  EXPECT_NO_THROW(validate(options));
  const RunOptions set = with_profile(options);
  EXPECT_NO_THROW(validate(set));
  EXPECT_FALSE(set.coarsen);
  EXPECT_EQ(set.improve, 0U);
  EXPECT_EQ(set.mesh.bounds.crease_angle, 90);
  EXPECT_EQ(set.mesh.bounds.radius_edge, 2.83);
  EXPECT_EQ(set.mesh.bounds.thin_angle, 0);
  EXPECT_EQ(set.mesh.exterior_radius_edge, 2.83);
  for (const auto& [name, text] : {std::pair{"crease-angle", "45"},
                                   {"collar-creation", "up-front"},
                                   {"improve", "3"},
                                   {"min-dihedral", "10"},
                                   {"radius-edge", "2"},
                                   {"theta", "0"}}) {
    RunOptions other = options;
    ASSERT_TRUE(row(name).read(text, other));
    EXPECT_THROW(validate(other), OptionError) << name;
    EXPECT_NO_THROW(validate([&] {
      other.mesh.profile = Profile::standard;
      return other;
    }()))
        << name;
  }
  RunOptions larger = options;
  ASSERT_TRUE(row("radius-edge").read("4", larger));
  EXPECT_NO_THROW(validate(larger));
  EXPECT_EQ(with_profile(larger).mesh.exterior_radius_edge, 4);
}

TEST(TagValue, Read) {
  EXPECT_EQ(read_tag_value("7=0.25"), (std::pair<Tag, double>(7, 0.25)));
  EXPECT_EQ(read_tag_value("-3=1e-3"), (std::pair<Tag, double>(-3, 1e-3)));
  for (const char* text :
       {"", "7", "=1", "7=", "7=0", "7=-1", "7=nan", "7=inf", "a=1", "7=1x", "1.5=2", "7 =1"})
    EXPECT_FALSE(read_tag_value(text)) << text;
}

TEST(Memory, Read) {
  for (const auto& [text, bytes] : {std::pair{"0", 0.0},
                                    {"2000", 2e3},
                                    {"3K", 3072.0},
                                    {"500m", 524288000.0},
                                    {"1.5G", 1610612736.0},
                                    {"2GiB", 2147483648.0},
                                    {"1tb", 1099511627776.0}})
    EXPECT_EQ(static_cast<double>(read_bytes(text).value()), bytes) << text;
  for (const char* text : {"", "G", "-1", "1X", "much", "nan", "inf", "1e30", "4 G", "4GG"})
    EXPECT_FALSE(read_bytes(text)) << text;
}

}  // namespace
}  // namespace collarmesh::options_test
