#include "files/cad_labels.h"

#include <fmt/format.h>

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

#include "io/label_names.h"

namespace collarmesh::files {

namespace {

constexpr std::size_t longest_name = 60;  // in bytes

/// Returns the length in bytes of the UTF-8 character at the front of a text, 0 if it is not valid.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t length = byte(0) < 0x80   ? 1
                             : byte(0) < 0xC2 ? 0
                             : byte(0) < 0xE0 ? 2
                             : byte(0) < 0xF0 ? 3
                             : byte(0) < 0xF5 ? 4
                                              : 0;
  if (length > text.size()) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  if (length < 3) return length;
  // Not valid: overlong forms (after E0 and F0), surrogates (ED), numbers above U+10FFFF (F4).
  const unsigned second = byte(1);
  const bool valid = byte(0) == 0xE0   ? second >= 0xA0
                     : byte(0) == 0xED ? second < 0xA0
                     : byte(0) == 0xF0 ? second >= 0x90
                     : byte(0) == 0xF4 ? second < 0x90
                                       : true;
  return valid ? length : 0;
}

/// Replaces invalid bytes, control characters and double quotes by `_`, cuts the text off at `longest_name`,
/// and removes blanks around the text.
std::string clean(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    const bool plain =
        length > 1 || (length == 1 && text.front() >= ' ' && text.front() != '"' && text.front() != 0x7F);
    if (result.size() + (plain ? length : 1) > longest_name) break;
    result += plain ? text.substr(0, length) : "_";
    text.remove_prefix(length == 0 ? 1 : length);
  }
  const std::size_t first = result.find_first_not_of(' ');
  return first == std::string::npos ? std::string()
                                    : result.substr(first, result.find_last_not_of(' ') + 1 - first);
}

/// Returns whether a reader would take the name for the number of a feature.
bool is_number(const std::string& name) {
  for (std::size_t dimension = 0; dimension < 4; ++dimension)
    if (io::tag_of_group_name(dimension, name)) return true;
  return false;
}

}  // namespace

void name_regions(const brep::CadLabels& labels, Plc& plc) {
  std::set<std::string> taken;  // names in the spelling that every format can store
  for (const auto& [tag, name] : plc.names.of(3)) taken.insert(io::capital_word(name));
  TagNames names;
  for (const auto& [number, text] : labels.solid_names) {
    const std::string name = clean(text);
    if (name.empty() || is_number(name) || plc.names.find(3, number) != nullptr) continue;
    std::string tried = name;
    for (std::size_t k = 2; !taken.insert(io::capital_word(tried)).second; ++k)
      tried = fmt::format("{}_{}", name, k);
    names.set(3, number, tried);
  }
  plc.names.add(names);
}

}  // namespace collarmesh::files
