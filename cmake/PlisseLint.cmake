# Targets `format`, `format-check` and `lint`.
file(GLOB_RECURSE plisse_files CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/src/*.h ${PROJECT_SOURCE_DIR}/src/*.cpp ${PROJECT_SOURCE_DIR}/apps/*.h
  ${PROJECT_SOURCE_DIR}/apps/*.cpp ${PROJECT_SOURCE_DIR}/tests/*.h ${PROJECT_SOURCE_DIR}/tests/*.cpp
  ${PROJECT_SOURCE_DIR}/bench/*.cpp ${PROJECT_SOURCE_DIR}/examples/*.h ${PROJECT_SOURCE_DIR}/examples/*.cpp)
set(plisse_sources ${plisse_files})
list(FILTER plisse_sources INCLUDE REGEX "/(src|apps)/.*\\.cpp$")
add_custom_target(format COMMAND clang-format -i ${plisse_files} VERBATIM)
add_custom_target(format-check COMMAND clang-format --dry-run --Werror ${plisse_files} VERBATIM)
add_custom_target(lint COMMAND clang-tidy -p ${CMAKE_BINARY_DIR} --quiet ${plisse_sources} VERBATIM)
