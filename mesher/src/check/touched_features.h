#pragma once

#include <string>
#include <vector>

#include "check/subject.h"

namespace collarmesh::checks {

/// The features of the complex that the corners of tets lie on, for messages.
class TouchedFeatures {
 public:
  /// Precondition: subject.match is filled in. Keeps a reference to the subject. Cost: linear.
  explicit TouchedFeatures(const Subject& subject);

  /// Names the region of a tet and the features that the tet touches: "in region 1 (tag 1) and touching curve
  /// 3 (tag 4), patch 0 (tag 7, inlet)". Curves and patches that contain most corners come first.
  std::string of(Index tet) const;

 private:
  const Subject& subject_;
  std::vector<TetMesh::VertexFeature> features_;
};

}  // namespace collarmesh::checks
