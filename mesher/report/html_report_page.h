#pragma once

#include <string_view>

namespace collarmesh::report {

/// The page of a report, made of the files in html_report/ and of three.js when the program is built. In
/// place of `<!--report-->`, `<!--shown-->` and `<!--data-->`, in this order, come those of a run.
extern const std::string_view html_report_page;

}  // namespace collarmesh::report
