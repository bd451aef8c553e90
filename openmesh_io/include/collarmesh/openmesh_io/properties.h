#pragma once

#include <OpenMesh/Core/Utils/Property.hh>
#include <cassert>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "collarmesh/error.h"
#include "collarmesh/geometry.h"

namespace collarmesh::openmesh_io {

// Names of properties. `boundary_surface` writes all of them except `vertex_tag`; `Surfaces::add` reads the
// three tags unless its options name other properties. Tags are std::int64_t.
inline constexpr const char* patch_tag = "collarmesh:patch_tag";      ///< face property
inline constexpr const char* curve_tag = "collarmesh:curve_tag";      ///< edge property
inline constexpr const char* vertex_tag = "collarmesh:vertex_tag";    ///< vertex property
inline constexpr const char* region_back = "collarmesh:region_back";  ///< face property: region behind, int
inline constexpr const char* region_front = "collarmesh:region_front";
/// Vertex property: int, index in TetMesh::points.
inline constexpr const char* mesh_point = "collarmesh:mesh_point";
/// Face property: int, index in TetMesh::faces.
inline constexpr const char* mesh_face = "collarmesh:mesh_face";

namespace detail {

/// A property whose values have one of several integer types. It is found by its name.
template <class Mesh, template <class> class Handle>
class TagProperty {
 public:
  /// Finds the property. An empty name stands for no property. Throws OptionError if the property is missing,
  /// unless its name is `optional`.
  TagProperty(const Mesh& mesh, const std::string& name, std::string_view optional) : mesh_(mesh) {
    if (name.empty()) return;
    const bool found =
        find<int>(name) || find<unsigned>(name) || find<std::int64_t>(name) || find<std::uint64_t>(name);
    if (!found && name != optional)
      throw OptionError("the OpenMesh mesh has no property '" + name +
                        "' of type int, unsigned, std::int64_t or std::uint64_t; add it or name another one");
  }

  explicit operator bool() const { return handle_.index() != 0; }

  /// Returns the value of an entity. Precondition: there is a property.
  template <class Entity>
  Tag operator[](Entity entity) const {
    assert(static_cast<bool>(*this));
    return std::visit(
        [&](const auto& handle) -> Tag {
          if constexpr (std::is_same_v<std::decay_t<decltype(handle)>, std::monostate>)
            return 0;
          else
            return static_cast<Tag>(mesh_.property(handle, entity));
        },
        handle_);
  }

 private:
  template <class Value>
  bool find(const std::string& name) {
    Handle<Value> handle;
    if (!mesh_.get_property_handle(handle, name)) return false;
    handle_ = handle;
    return true;
  }

  const Mesh& mesh_;
  std::variant<std::monostate, Handle<int>, Handle<unsigned>, Handle<std::int64_t>, Handle<std::uint64_t>>
      handle_;
};

}  // namespace detail

}  // namespace collarmesh::openmesh_io
