#include "collarmesh/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <type_traits>

#include "collarmesh/error.h"

namespace collarmesh {

namespace {

/// Reads a number; the text must contain nothing else.
template <class Number>
bool read_whole(std::string_view text, Number& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

template <class Number>
std::optional<OptionValue> read_number(std::string_view text) {
  Number number{};
  return read_whole(text, number) ? std::optional<OptionValue>(number) : std::nullopt;
}

std::optional<OptionValue> read_word(const Option& option, const std::string& text) {
  const auto word = std::ranges::find(option.words, text);
  if (word == option.words.end()) return std::nullopt;
  return std::holds_alternative<bool>(option.get({})) ? OptionValue(word == option.words.begin()) : text;
}

/// Returns the value of a repeatable option after the entry `text` is added to it; nothing if `text` is
/// malformed.
std::optional<OptionValue> read_more(const std::string& text, OptionValue value) {
  if (auto* const texts = std::get_if<std::vector<std::string>>(&value)) {
    texts->push_back(text);
    return value;
  }
  const auto size = read_tag_value(text);
  if (!size) return std::nullopt;
  std::get<std::map<Tag, double>>(value).insert_or_assign(size->first, size->second);
  return value;
}

std::optional<OptionValue> value_of(const Option& option, const std::string& text, const RunOptions& before) {
  switch (option.kind()) {
    case Option::Kind::flag: return std::nullopt;
    case Option::Kind::choice: return read_word(option, text);
    case Option::Kind::count:
      return option.unit == Option::Unit::bytes ? read_bytes(text) : read_number<std::uint64_t>(text);
    case Option::Kind::number: return read_number<double>(text);
    case Option::Kind::text: return text;
    default: return read_more(text, option.get(before));
  }
}

bool is_in_range(const Option& option, double value) {
  return (value >= option.low && value <= option.high && std::isfinite(value)) || (option.zero && value == 0);
}

std::string noun(const Option& option) {
  switch (option.unit) {
    case Option::Unit::length: return "a length";
    case Option::Unit::degrees: return "an angle";
    case Option::Unit::ratio: return "a ratio";
    case Option::Unit::seconds: return "a number of seconds";
    default: return option.kind() == Option::Kind::count ? "a whole number" : "a number";
  }
}

std::string numbers_that_fit(const Option& option) {
  constexpr double few = 4;
  std::string range;
  if (option.kind() == Option::Kind::count && option.high - option.low < few) {
    for (double number = option.low; number <= option.high; ++number)
      range += fmt::format("{}{}", range.empty() ? "one of " : ", ", number);
    return range;
  }
  if (std::isfinite(option.high))
    range = fmt::format(" from {:.9g} to {:.9g}", option.low, option.high);
  else
    range = option.low == 0 ? " >= 0" : fmt::format(" of at least {:.9g}", option.low);
  const char* const suffix = option.unit == Option::Unit::length        ? " in input units"
                             : option.unit == Option::Unit::degrees     ? " degrees"
                             : option.unit == Option::Unit::of_diagonal ? " (relative to the diagonal)"
                                                                        : "";
  return noun(option) + range + suffix + (option.zero ? ", or 0" : "");
}

std::string text_of(const Option& option, const OptionValue& value) {
  return std::visit(
      [&option]<class T>(const T& v) -> std::string {
        if constexpr (std::is_same_v<T, bool>)
          return option.words.empty() ? std::string() : option.words[v ? 0 : 1];
        else if constexpr (std::is_same_v<T, std::string>)
          return v;
        else if constexpr (std::is_arithmetic_v<T>)
          return fmt::format("{}", v);
        else
          return {};
      },
      value);
}

void require(bool holds, const std::string& message) {
  if (!holds) throw OptionError(message);
}

/// Throws OptionError if an option has a value that is neither its default nor the one that the profile sets.
void require_as_profile_sets(const RunOptions& options) {
  const RunOptions set = with_profile(options), defaults;
  for (const Option& option : option_table()) {
    const OptionValue value = option.get(options);
    if (value == option.get(set) || value == option.get(defaults)) continue;
    throw OptionError(fmt::format("{} {} contradicts profile paper, which sets {}; leave out one of the two",
                                  option.name, text_of(option, value), text_of(option, option.get(set))));
  }
}

/// Checks the rules that concern several options.
void require_consistent(const RunOptions& o) {
  require(o.mesh.size == 0 || o.mesh.size_min <= o.mesh.size,
          fmt::format("size-min {} exceeds size {}; make it smaller", o.mesh.size_min, o.mesh.size));
  require(o.split.any() || (o.split.interaction == Interaction::free && !o.split.cohesive),
          "interaction and cohesive are for patches that are split; add split or keep-apart");
  require(o.layers.any() || !o.layers.tets, "layers-tets is for layers; add layers, or leave it out");
  require(!o.layers.any() || o.dimension == 3,
          "layers are for meshes of solids; leave layers or dimension out");
  require(!o.layers.any() || !o.split.any(),
          "layers and split both change the nodes of faces; leave one of them out");
  require(!o.layers.any() || !o.periodic.any(),
          "layers would move nodes of periodic faces away from their images; leave layers or periodic out");
  require(!o.layers.any() || o.layers.tets || o.partitions == 0,
          "partitions consist of tetrahedra alone; add layers-tets, or leave partitions out");
  read_walls(o.layers);
  require(!o.split.any() || !o.periodic.any(),
          "split and keep-apart would copy nodes on periodic faces, and the copies would have no images; "
          "leave out either these or periodic");
  require(
      o.coarsen || !o.periodic.any(),
      "periodic needs coarsening, for the elements beside the faces; leave periodic out, or set coarsen on");
  require(o.faces.empty() || o.dimension == 2,
          "faces are for triangles alone; add dimension 2, or leave them out");
  require(o.triangle_elements == TriangleElements::shell || o.dimension == 2,
          "triangle-elements are for triangles alone; add dimension 2, or leave them out");
  const bool is_papers = o.mesh.profile == Profile::paper;
  require(o.start != Start::constrained || (o.coarsen && !is_papers),
          "start constrained needs coarsening, which coarsen off and profile paper switch off; leave out "
          "either start constrained or these");
  require(!o.mesh.bounds.interior_node || (o.coarsen && !is_papers),
          "interior-node needs coarsening, which coarsen off and profile paper switch off; leave out either "
          "interior-node or these");
  require(!is_papers || o.mesh.bounds.radius_edge * o.mesh.bounds.radius_edge > 8 ||
              !o.mesh.bounds.thin_in_narrow_places_only,
          "radius-edge must be above 2 sqrt 2 with profile paper; make it 2.83 or more");
  require(!is_papers || o.mesh.theta > 0, "theta must be above 0 with profile paper; make it 0.3");
  require(is_papers || !o.coarsen || o.mesh.bounds.thin_angle > 0,
          "thin-angle 0 is for meshes without coarsening; make it at least 0.1, or set coarsen off");
}

}  // namespace

std::optional<std::pair<Tag, double>> read_tag_value(std::string_view text) {
  const std::size_t equals = text.find('=');
  std::pair<Tag, double> result;
  if (equals == std::string_view::npos || !read_whole(text.substr(0, equals), result.first) ||
      !read_whole(text.substr(equals + 1), result.second) || !std::isfinite(result.second) ||
      result.second <= 0)
    return std::nullopt;
  return result;
}

std::optional<std::size_t> read_bytes(std::string_view text) {
  constexpr std::string_view prefixes = "kmgt";
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; });
  std::string_view number = lower;
  if (number.ends_with("ib"))
    number.remove_suffix(2);
  else if (number.ends_with("b"))
    number.remove_suffix(1);
  double unit = 1;
  if (!number.empty())
    if (const std::size_t prefix = prefixes.find(number.back()); prefix != std::string_view::npos) {
      unit = std::pow(1024.0, static_cast<double>(prefix + 1));
      number.remove_suffix(1);
    }
  double value = 0;
  if (!read_whole(number, value) || !(value >= 0) || value * unit >= 0x1p63) return std::nullopt;
  return static_cast<std::size_t>(value * unit);
}

std::string Option::key() const {
  std::string key = name;
  std::ranges::replace(key, '-', '_');
  return key;
}

bool Option::read(const std::string& text, RunOptions& options) const {
  const std::optional<OptionValue> value = value_of(*this, text, options);
  if (!value || !fits(*value)) return false;
  set(options, *value);
  return true;
}

bool Option::fits(const OptionValue& value) const {
  if (const auto* number = std::get_if<double>(&value)) return is_in_range(*this, *number);
  if (const auto* count = std::get_if<std::uint64_t>(&value))
    return is_in_range(*this, static_cast<double>(*count));
  if (const auto* word = std::get_if<std::string>(&value); word != nullptr && kind() == Kind::choice)
    return std::ranges::find(words, *word) != words.end();
  if (const auto* sizes = std::get_if<std::map<Tag, double>>(&value))
    return std::ranges::all_of(
        *sizes, [](const auto& size) { return size.second > 0 && std::isfinite(size.second); });
  return true;
}

std::string Option::fitting() const {
  switch (kind()) {
    case Kind::choice: return fmt::format("one of {}", fmt::join(words, ", "));
    case Kind::count:
    case Kind::number:
      return unit == Unit::bytes ? "a size such as 500M, 1.5G or 2000000000" : numbers_that_fit(*this);
    case Kind::sizes: return "TAG=LENGTH with a whole number and a positive length, as in 7=0.25";
    default: return "text";
  }
}

std::string Option::default_value() const {
  return default_text.empty() ? text_of(*this, get({})) : default_text;
}

void validate(const RunOptions& options) {
  const RunOptions defaults;
  for (const Option& option : option_table()) {
    const OptionValue value = option.get(options);
    if (option.fits(value) || value == option.get(defaults)) continue;
    if (const auto* sizes = std::get_if<std::map<Tag, double>>(&value))
      for (const auto& [tag, size] : *sizes)
        require(size > 0 && std::isfinite(size),
                fmt::format("{} {}={}: the length must be positive", option.name, tag, size));
    throw OptionError(
        fmt::format("{} must be {}, not {}", option.name, option.fitting(), text_of(option, value)));
  }
  require_consistent(options);
  require_as_profile_sets(options);
}

}  // namespace collarmesh
