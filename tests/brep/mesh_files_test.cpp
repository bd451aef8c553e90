// The way from files to a mesh in one call.
#include "collarmesh/mesh_files.h"

#include <gtest/gtest.h>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepTools.hxx>

#include <map>
#include <string>

#include "support/temporary_file.h"

namespace collarmesh::testing::mesh_files_test {
namespace {

TEST(MeshFiles, GivesSingleNames) {
  const TemporaryFolder folder;
  const std::string path = folder.file("box.brep");
  BRepTools::Write(BRepPrimAPI_MakeBox(10, 10, 10).Shape(), path.c_str());
  RunOptions options;
  options.mesh.size = 10;
  options.names = R"({"patches": {"inlet": 1}})";
  options.given_names = {"wall=2,3"};
  const TagNames names = mesh_files({path}, options).result.mesh.names;
  const std::map<Tag, std::string> wanted{{1, "inlet"}, {2, "wall"}};  // faces of one name get one number
  EXPECT_EQ(names.of(2), wanted);
}

}  // namespace
}  // namespace collarmesh::testing::mesh_files_test
