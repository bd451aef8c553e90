# C++20 and the project's warnings for a target; they are not passed on to users of it.
function(collarmesh_options target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wpedantic -Wshadow $<$<BOOL:${COLLARMESH_WERROR}>:-Werror>)
endfunction()
