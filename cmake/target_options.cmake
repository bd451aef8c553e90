# collarmesh_options(TARGET [QUICKLY_COMPILED]): sets C++20 and the project's warnings for a target; users of the target
# also get C++20, but not the warnings. QUICKLY_COMPILED is for code whose running time does not matter: a Release build
# then compiles the target with -O1, which takes a third less time.
function(collarmesh_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow $<$<BOOL:${COLLARMESH_WERROR}>:-Werror>)
  if("QUICKLY_COMPILED" IN_LIST ARGN)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
endfunction()
