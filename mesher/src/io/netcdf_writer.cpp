#include "io/netcdf_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "collarmesh/error.h"
#include "io/number_bytes.h"

namespace collarmesh::io {

namespace {

constexpr std::uint32_t of_text = 2, of_wholes = 4, of_floats = 5, of_doubles = 6;
constexpr std::uint32_t dimension_list = 10, variable_list = 11, attribute_list = 12;

template <class Number>
void append(std::string& bytes, Number value) {
  const auto added = bytes_of(value, std::endian::big);
  bytes.append(added.begin(), added.end());
}
void append32(std::string& bytes, std::uint64_t value) { append(bytes, static_cast<std::uint32_t>(value)); }

std::uint64_t padded(std::uint64_t bytes) { return (bytes + 3) / 4 * 4; }

void append_padded(std::string& bytes, std::string_view text) {
  bytes += text;
  bytes.append(padded(text.size()) - text.size(), '\0');
}
void append_name(std::string& bytes, std::string_view name) {
  append32(bytes, name.size());
  append_padded(bytes, name);
}

void append_attributes(std::string& bytes, const std::vector<NetcdfWriter::Attribute>& attributes) {
  append32(bytes, attributes.empty() ? 0 : attribute_list);
  append32(bytes, attributes.size());
  for (const NetcdfWriter::Attribute& attribute : attributes) {
    append_name(bytes, attribute.name);
    append32(bytes, attribute.type);
    append32(bytes, attribute.count);
    append_padded(bytes, attribute.bytes);
  }
}

std::uint64_t size_of(std::uint32_t type) { return type == of_text ? 1 : type == of_doubles ? 8 : 4; }

}  // namespace

std::size_t NetcdfWriter::add_dimension(std::string_view name, std::size_t length) {
  dimensions_.push_back({std::string(name), length, false});
  return dimensions_.size() - 1;
}

std::size_t NetcdfWriter::add_unlimited_dimension(std::string_view name) {
  dimensions_.push_back({std::string(name), 0, true});
  return dimensions_.size() - 1;
}

NetcdfWriter::Attribute NetcdfWriter::text(std::string name, const std::string& value) {
  return {std::move(name), value, of_text, static_cast<std::uint32_t>(value.size())};
}

NetcdfWriter::Attribute NetcdfWriter::whole(std::string name, std::int32_t value) {
  Attribute attribute{std::move(name), {}, of_wholes, 1};
  append(attribute.bytes, value);
  return attribute;
}

NetcdfWriter::Attribute NetcdfWriter::real(std::string name, float value) {
  Attribute attribute{std::move(name), {}, of_floats, 1};
  append(attribute.bytes, value);
  return attribute;
}

void NetcdfWriter::add_text(std::string name, const std::vector<std::size_t>& dimensions) {
  variables_.push_back({std::move(name), dimensions, {}, of_text});
}

void NetcdfWriter::add_whole(std::string name, const std::vector<std::size_t>& dimensions,
                             std::vector<Attribute> attributes) {
  variables_.push_back({std::move(name), dimensions, std::move(attributes), of_wholes});
}

void NetcdfWriter::add_real(std::string name, const std::vector<std::size_t>& dimensions) {
  variables_.push_back({std::move(name), dimensions, {}, of_doubles});
}

bool NetcdfWriter::grows(const Variable& variable) const {
  return !variable.dimensions.empty() && dimensions_[variable.dimensions.front()].unlimited;
}

/// Returns the size in bytes, with padding, of all values of a variable or, if it grows, of one record.
std::uint64_t NetcdfWriter::bytes_of(const Variable& variable) const {
  std::uint64_t bytes = size_of(variable.type);
  for (const std::size_t d : variable.dimensions)
    if (!dimensions_[d].unlimited) bytes *= dimensions_[d].length;
  return padded(bytes);
}

std::string NetcdfWriter::header(std::uint64_t first_value) const {
  std::string bytes = "CDF\2";
  append32(bytes, 0);  // number of records
  append32(bytes, dimension_list);
  append32(bytes, dimensions_.size());
  for (const Dimension& dimension : dimensions_) {
    append_name(bytes, dimension.name);
    append32(bytes, dimension.length);
  }
  append_attributes(bytes, attributes_);
  append32(bytes, variable_list);
  append32(bytes, variables_.size());
  std::uint64_t fixed = 0;  // bytes of the variables that do not grow; records follow them
  for (const Variable& variable : variables_) fixed += grows(variable) ? 0 : bytes_of(variable);
  std::uint64_t value = first_value, record = first_value + fixed;
  for (const Variable& variable : variables_) {
    append_name(bytes, variable.name);
    append32(bytes, variable.dimensions.size());
    for (const std::size_t d : variable.dimensions) append32(bytes, d);
    append_attributes(bytes, variable.attributes);
    append32(bytes, variable.type);
    append32(bytes, bytes_of(variable));
    std::uint64_t& begin = grows(variable) ? record : value;
    append(bytes, begin);
    begin += bytes_of(variable);
  }
  return bytes;
}

void NetcdfWriter::write_header() {
  constexpr std::uint64_t most = (std::uint64_t{1} << 32) - 4;
  for (const Variable& variable : variables_)
    if (bytes_of(variable) > most)
      throw WriteError(
          fmt::format("{}: the mesh is too large for this format: {} would have {} bytes; write .vtu", path_,
                      variable.name, bytes_of(variable)));
  out_ << std::string_view(header(header(0).size()));
}

void NetcdfWriter::write(std::int32_t value) { out_.append_bytes(value, std::endian::big); }

void NetcdfWriter::write(double value) { out_.append_bytes(value, std::endian::big); }

void NetcdfWriter::write(const std::string& text, std::size_t length) {
  const std::size_t kept = std::min(text.size(), length);
  out_ << std::string_view(text).substr(0, kept) << std::string_view(std::string(length - kept, '\0'));
  written_ += length;
}

void NetcdfWriter::end_variable() {
  out_ << std::string_view(std::string(padded(written_) - written_, '\0'));
  written_ = 0;
}

}  // namespace collarmesh::io
