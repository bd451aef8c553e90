#include "options.h"

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <cmath>
#include <map>
#include <memory>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "arrays.h"
#include "collarmesh/error.h"
#include "collarmesh/io/size_field_io.h"
#include "process/machine.h"

namespace py = pybind11;

namespace collarmesh::python {

namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& fitting, const py::handle& given) {
  throw OptionError(fmt::format("{} must be {}, not {}", name, fitting, std::string(py::repr(given))));
}

const char* type_of(const OptionValue& value) {
  return std::visit(
      []<class T>(const T&) {
        return std::is_same_v<T, bool>                       ? "True or False"
               : std::is_same_v<T, double>                   ? "a number"
               : std::is_same_v<T, std::uint64_t>            ? "a whole number that is not negative"
               : std::is_same_v<T, std::map<Tag, double>>    ? "a dict of tags and lengths, {3: 0.1}"
               : std::is_same_v<T, std::vector<std::string>> ? "a list of texts"
                                                             : "text";
      },
      value);
}

void take(const Option& option, const py::handle& given, Options& options) {
  if (option.unit == Option::Unit::bytes && py::isinstance<py::str>(given)) {
    if (!option.read(given.cast<std::string>(), options)) refuse(option.key(), option.fitting(), given);
    return;
  }
  OptionValue value = option.get(options);
  try {
    std::visit([&given]<class T>(T& v) { v = given.cast<T>(); }, value);
  } catch (const py::cast_error&) {
    refuse(option.key(), type_of(value), given);
  }
  if (!option.fits(value)) refuse(option.key(), option.fitting(), given);
  option.set(options, value);
}

/// Keeps a Python object and, when it is no longer used, releases it with the interpreter's lock held.
std::shared_ptr<py::object> kept(const py::object& object) {
  return {new py::object(object), [](py::object* held) {
            const py::gil_scoped_acquire acquire;
            delete held;
          }};
}

[[noreturn]] void refuse_size(const std::string& given, const Point& p) {
  throw OptionError(
      fmt::format("size_field gave {} at ({:.9g}, {:.9g}, {:.9g}); it must give a positive length", given,
                  p.x, p.y, p.z));
}

/// Wraps a callable of a place; holds the interpreter's lock during calls.
SizeField field_of(const py::object& callable) {
  return [function = kept(callable)](const Point& p) {
    const py::gil_scoped_acquire acquire;
    const py::object given = (*function)(p.x, p.y, p.z);
    double size = NAN;
    try {
      size = given.cast<double>();
    } catch (const py::cast_error&) {
    }
    if (!(size > 0)) refuse_size(py::repr(given), p);
    return size;
  };
}

/// Wraps a callable of an array of places, one per row, that returns an array of sizes.
SizesAt sizes_of_arrays(const py::object& callable) {
  return [function = kept(callable)](const std::vector<Point>& places) {
    const py::gil_scoped_acquire acquire;
    const auto count = static_cast<py::ssize_t>(places.size());
    const py::object rows = py::array_t<double>({count, py::ssize_t{3}}, &places.front().x);
    const py::object given = (*function)(rows);
    const auto sizes = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
    if (!sizes) PyErr_Clear();
    if (!sizes || sizes.ndim() != 1 || sizes.size() != count)
      throw OptionError(
          fmt::format("size_field must give an array of shape (n,) for places of shape (n, 3), not {}",
                      sizes ? "one of shape " + std::string(py::str(sizes.attr("shape")))
                            : std::string(py::repr(given))));
    for (py::ssize_t i = 0; i < count; ++i)
      if (!(sizes.at(i) > 0)) refuse_size(fmt::format("{}", sizes.at(i)), places[i]);
    return std::vector<double>(sizes.data(), sizes.data() + count);
  };
}

/// Returns whether a callable takes one argument, the places, instead of x, y and z.
bool takes_arrays(const py::object& callable) {
  return py::module_::import("collarmesh._inputs").attr("takes_arrays")(callable).cast<bool>();
}

void take_size_field(const py::object& field, Options& options) {
  if (py::isinstance<py::dict>(field) && py::dict(field).contains("tets")) {
    const py::dict arrays(field);
    options.mesh.size_field =
        size_field_on_mesh(tet_mesh_of(arrays), arrays["values"].cast<std::vector<double>>());
  } else if (py::isinstance<py::dict>(field)) {
    options.size_field_json = py::module_::import("json").attr("dumps")(field).cast<std::string>();
  } else if (py::isinstance<py::str>(field)) {
    options.size_field_file = field.cast<std::string>();
  } else if (takes_arrays(field)) {
    options.sizes_at = sizes_of_arrays(field);
  } else {
    options.mesh.size_field = field_of(field);
  }
}

}  // namespace

SizeField size_field_for(const Plc& plc, const Options& options) {
  if (!options.size_field_file.empty()) return io::read_size_field(options.size_field_file, plc);
  if (!options.size_field_json.empty()) return size_field_from_json(options.size_field_json, plc);
  if (options.sizes_at) return sampled_sizes(options.sizes_at, plc.bounds);
  return {};
}

Options options_of(const py::dict& given) {
  Options options;
  options.mesh.max_memory = process::memory_of_the_machine() / 2;
  for (const Option& option : option_table()) {
    if (!option.is_for(Option::programs) || !given.contains(option.key())) continue;
    const py::object value = given[py::str(option.key())];
    if (option.name == "size-field")
      take_size_field(value, options);
    else if (option.name == "names" && !py::isinstance<py::str>(value))
      options.names = py::module_::import("json").attr("dumps")(value).cast<std::string>();
    else
      take(option, value, options);
  }
  for (const auto& [name, format] :
       {std::pair("format", &options.output_format), std::pair("input_format", &options.input_format)}) {
    if (!given.contains(name)) continue;
    if (!py::isinstance<py::str>(given[name])) refuse(name, "an extension", given[name]);
    *format = given[name].cast<std::string>();
  }
  return options;
}

}  // namespace collarmesh::python
