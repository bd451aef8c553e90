// write_two_solids FILE.brep: a plate and a pin that stands on it, which share a disc.
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Ax2.hxx>

int main(int argc, char** argv) {
  BRep_Builder builder;
  TopoDS_Compound both;
  builder.MakeCompound(both);
  builder.Add(both, BRepPrimAPI_MakeBox(40, 30, 8).Shape());
  builder.Add(both, BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(20, 15, 8), gp::DZ()), 7, 12).Shape());
  return argc == 2 && BRepTools::Write(both, argv[1]) ? 0 : 1;
}
