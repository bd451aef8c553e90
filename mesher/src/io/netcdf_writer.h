#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/file_writer.h"

namespace collarmesh::io {

/// A writer of NetCDF's classic format with offsets of 64 bits (docs.unidata.ucar.edu, "NetCDF Classic Format
/// Specification"): first a description, then the values of the variables in their order, numbers with the
/// highest byte first.
class NetcdfWriter {
 public:
  explicit NetcdfWriter(const std::string& path) : path_(path), out_(path) {}

  /// Adds a dimension and returns its number.
  std::size_t add_dimension(std::string_view name, std::size_t length);
  /// Adds a dimension that other programs can extend, and returns its number; its length is 0.
  std::size_t add_unlimited_dimension(std::string_view name);

  struct Attribute {
    std::string name, bytes;
    std::uint32_t type, count;
  };
  static Attribute text(std::string name, const std::string& value);
  static Attribute whole(std::string name, std::int32_t value);
  static Attribute real(std::string name, float value);

  void add_attribute(Attribute attribute) { attributes_.push_back(std::move(attribute)); }
  void add_text(std::string name, const std::vector<std::size_t>& dimensions);
  void add_whole(std::string name, const std::vector<std::size_t>& dimensions,
                 std::vector<Attribute> attributes = {});
  void add_real(std::string name, const std::vector<std::size_t>& dimensions);

  /// Writes the description of all dimensions, attributes and variables. Throws WriteError for a variable
  /// that is too large for the format.
  void write_header();
  /// Write the values of the next variable that does not grow, one after the other. After the last one call
  /// `end_variable`.
  void write(std::int32_t value);
  void write(double value);
  /// Writes a text, cut off or padded with zeros to `length` bytes.
  void write(const std::string& text, std::size_t length);
  void end_variable();
  void commit() { out_.commit(); }

 private:
  struct Dimension {
    std::string name;
    std::size_t length;
    bool unlimited;
  };
  struct Variable {
    std::string name;
    std::vector<std::size_t> dimensions;
    std::vector<Attribute> attributes;
    std::uint32_t type;
  };

  bool grows(const Variable& variable) const;
  std::uint64_t bytes_of(const Variable& variable) const;
  std::string header(std::uint64_t first_value) const;

  std::string path_;
  FileWriter out_;
  std::vector<Dimension> dimensions_;
  std::vector<Attribute> attributes_;
  std::vector<Variable> variables_;
  std::uint64_t written_ = 0;  // bytes of text in the current variable
};

}  // namespace collarmesh::io
