#include "refine/outcome.h"

#include <fmt/format.h>

namespace collarmesh {

void Outcome::give_up(const Point& where, const std::string& what, const std::string& next) {
  if (given_up()) return;
  where_ = where;
  const Point p = frame_.outside(where);
  message_ = fmt::format("{} near ({:.9g}, {:.9g}, {:.9g}); {}", what, p.x, p.y, p.z, next);
}

void Outcome::stop(MeshStatus status, const Point& where, const std::string& what, const std::string& next) {
  status_ = status;
  message_.clear();
  give_up(where, what, next);
}

}  // namespace collarmesh
