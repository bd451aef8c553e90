# The page of reports as HTML: html_report/ and three.js, put together into a source that holds it as a string.
find_file(COLLARMESH_THREE three.min.js PATHS /usr/share/javascript/three NO_DEFAULT_PATH
  DOC "three.js, for the view in reports as HTML")
find_file(COLLARMESH_ORBIT_CONTROLS OrbitControls.js
  PATHS /usr/share/javascript/three/examples/js/controls NO_DEFAULT_PATH DOC "the controls of three.js")
if(NOT COLLARMESH_THREE OR NOT COLLARMESH_ORBIT_CONTROLS)
  message(STATUS "three.js is not there: reports as HTML will have no view of the mesh (package libjs-three)")
endif()

function(collarmesh_html_report_page folder source)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
    ${folder}/page.html ${folder}/page.css ${folder}/facts.js ${folder}/view.js ${folder}/page.js)
  file(READ ${folder}/page.html page)
  file(READ ${folder}/page.css style)
  set(script "")
  foreach(name facts view page)
    file(READ ${folder}/${name}.js text)
    string(APPEND script "${text}")
  endforeach()
  set(library "")
  if(COLLARMESH_THREE AND COLLARMESH_ORBIT_CONTROLS)
    foreach(file ${COLLARMESH_THREE} ${COLLARMESH_ORBIT_CONTROLS})
      file(READ ${file} text)
      string(APPEND library "${text}\n")
    endforeach()
  endif()
  foreach(part style library script)
    string(REPLACE "<!--${part}-->" "${${part}}" page "${page}")
  endforeach()
  # Compilers join adjacent literals to one string; each literal is shorter than the limit that compilers may have.
  string(LENGTH "${page}" length)
  set(literals "")
  set(at 0)
  while(at LESS length)
    string(SUBSTRING "${page}" ${at} 16000 piece)
    string(APPEND literals "R\"page(${piece})page\"\n")
    math(EXPR at "${at} + 16000")
  endwhile()
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT
"#include \"report/html_report_page.h\"

namespace collarmesh::report {

const std::string_view html_report_page =
@literals@;

}  // namespace collarmesh::report
")
endfunction()
