#include "predict/vertex_counts.h"

#include <gtest/gtest.h>

#include <vector>

#include "collarmesh/plc_builder.h"
#include "support/meshing.h"
#include "support/shapes.h"

namespace collarmesh::vertex_counts_test {
namespace {

using namespace testing;

TEST(CountTets, StopsWhenThereAreEnough) {
  const Plc plc = build_plc(std::vector{box()});
  const prediction::Shape shape(plc);
  const MeshOptions options = with_size(0.05);
  const double all = prediction::count_tets(shape, options);
  EXPECT_EQ(prediction::count_tets(shape, options, {}, 2 * all), all);
  for (const double share : {0.01, 0.1, 0.5}) {
    const double found = prediction::count_tets(shape, options, {}, share * all);
    EXPECT_GE(found, share * all);
    EXPECT_LT(found, (share + 0.25) * all);
  }
}

}  // namespace
}  // namespace collarmesh::vertex_counts_test
