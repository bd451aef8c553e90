// Faces of spheres that the reader took for the other side of their outline.
#include "sphere_sides.h"

#include <gtest/gtest.h>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <GProp_GProps.hxx>
#include <STEPControl_Writer.hxx>
#include <TopoDS.hxx>
#include <gp_Ax2.hxx>

#include <cmath>
#include <memory>
#include <numbers>

#include "collarmesh/brep/cad_model.h"
#include "collarmesh/plc_builder.h"
#include "shapes.h"
#include "support/leaks_allowed.h"
#include "support/temporary_file.h"
#include "topology.h"

namespace collarmesh::testing::sphere_sides_test {
namespace {

constexpr double radius = 60, bore = 18, pi = std::numbers::pi;

/// Returns half of a ball, of two quarters that meet at the seam of one, with a bore that begins there.
TopoDS_Shape half_ball_with_bore() {
  const gp_Pnt centre(0, 0, 0);
  const gp_Dir up(0, 0, 1), back(-1, 0, 0);
  const TopoDS_Shape left =
      BRepPrimAPI_MakeSphere(gp_Ax2(centre, up, gp_Dir(0, 1, 0)), radius, -pi / 2, pi / 2, pi / 2).Shape();
  const TopoDS_Shape right =
      BRepPrimAPI_MakeSphere(gp_Ax2(centre, up, back), radius, -pi / 2, pi / 2, pi / 2).Shape();
  const TopoDS_Shape hole = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-20, 0, 0), back), bore, radius).Shape();
  return BRepAlgoAPI_Cut(BRepAlgoAPI_Fuse(left, right).Shape(), hole).Shape();
}

/// Returns the volume of that shape by formulas: of half a ball, less a cylinder and the cap above it.
double exact_volume() {
  const double up_to = std::sqrt(radius * radius - bore * bore), height = radius - up_to;
  return 2 * pi / 3 * radius * radius * radius - pi * bore * bore * (up_to - 20) -
         pi * height * height * (3 * radius - height) / 3;
}

double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

double area_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(shape, properties);
  return properties.Mass();
}

class ShapeFromFile {
 public:
  ShapeFromFile() {
    const std::string path = folder_.file("ball.step");
    const LeaksAllowed of_writer_and_reader;
    reader_ = std::make_unique<STEPControl_Reader>();
    STEPControl_Writer writer;
    writer.Transfer(half_ball_with_bore(), STEPControl_AsIs);
    writer.Write(path.c_str());
    reader_->ReadFile(path.c_str());
    reader_->TransferRoots();
    shape_ = reader_->OneShape();
    shell_ = brep::subshapes(shape_, TopAbs_SHELL).at(0);
  }
  const STEPControl_Reader& reader() const { return *reader_; }
  const TopoDS_Shape& shape() const { return shape_; }
  const TopoDS_Shape& shell() const { return shell_; }

 private:
  TemporaryFolder folder_;
  std::unique_ptr<STEPControl_Reader> reader_;
  TopoDS_Shape shape_, shell_;
};

TEST(SphereSides, BothSidesOfAnOutlineMakeTheSphere) {
  const ShapeFromFile file;
  std::size_t turned = 0;
  const auto count = faces_of(file.shell()).size();
  for (std::size_t f = 0; f < count; ++f) {
    const double before = area_of(faces_of(file.shell())[f]);
    if (!brep::take_other_side(file.shell(), f)) {
      EXPECT_EQ(area_of(faces_of(file.shell())[f]), before);
      continue;
    }
    ++turned;
    EXPECT_NEAR(before + area_of(faces_of(file.shell())[f]), 4 * pi * radius * radius, 1e-3 * before);
  }
  EXPECT_EQ(turned, 2U);
}

TEST(SphereSides, FacesTurnedAgainstTheFileAreMended) {
  const ShapeFromFile file;
  EXPECT_NEAR(volume_of(file.shape()), exact_volume(), 1e-3 * exact_volume());
  std::size_t turned = 0;
  for (std::size_t f = 0; turned == 0 && f < faces_of(file.shell()).size(); ++f)
    turned += brep::take_other_side(file.shell(), f) ? 1 : 0;
  ASSERT_EQ(turned, 1U);
  EXPECT_GT(std::fabs(volume_of(file.shape()) - exact_volume()), exact_volume());  // it crosses itself now
  brep::mend_sphere_sides(file.reader(), file.shape());
  EXPECT_NEAR(volume_of(file.shape()), exact_volume(), 1e-3 * exact_volume());
  brep::CadModel model(file.shape(), "ball");
  const Plc plc = build_plc(model.tessellate({}));
  ASSERT_EQ(plc.regions.size(), 2U);
  EXPECT_NEAR(plc.regions[1].volume, exact_volume(), 0.01 * exact_volume());
}

TEST(SphereSides, FacesAsInTheFileStay) {
  const ShapeFromFile file;
  const double before = volume_of(file.shape());
  brep::mend_sphere_sides(file.reader(), file.shape());
  EXPECT_EQ(volume_of(file.shape()), before);
}

}  // namespace
}  // namespace collarmesh::testing::sphere_sides_test
