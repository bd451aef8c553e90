#pragma once

#include <string_view>

namespace collarmesh::report {

/// The page of a report, made at build time from the files in html_report/ and from three.js. The data of a
/// run replace `<!--report-->`, `<!--shown-->`, `<!--data-->` and `<!--trace-->`, in this order.
extern const std::string_view html_report_page;

}  // namespace collarmesh::report
