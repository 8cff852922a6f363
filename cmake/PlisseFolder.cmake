# plisse_folder(NAME LINKS ...): the library plisse_NAME made of src/plisse/NAME, seen by others as <plisse/NAME/...>.
function(plisse_folder name)
  cmake_parse_arguments(FOLDER "" "" "LINKS;PRIVATE_LINKS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  add_library(plisse_${name} STATIC ${sources})
  set_target_properties(plisse_${name} PROPERTIES LINKER_LANGUAGE CXX POSITION_INDEPENDENT_CODE ON EXPORT_NAME ${name})
  target_include_directories(plisse_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:include>)
  target_compile_features(plisse_${name} PUBLIC cxx_std_20)
  # Eigen's alignment follows the processor flags; users of the library must agree with it.
  target_compile_definitions(plisse_${name} PUBLIC EIGEN_MAX_ALIGN_BYTES=32)
  target_link_libraries(plisse_${name} PUBLIC ${FOLDER_LINKS} PRIVATE $<BUILD_INTERFACE:plisse_compiler> ${FOLDER_PRIVATE_LINKS})
  set_property(GLOBAL APPEND PROPERTY PLISSE_FOLDERS plisse_${name})
endfunction()

# plisse_tests(NAME [HAS_SLOW] LINKS ...): the test program test_NAME made of tests/NAME. With HAS_SLOW, suites whose
# names begin with Slow get the label slow.
function(plisse_tests name)
  cmake_parse_arguments(TESTS "HAS_SLOW" "" "LINKS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${name}/*.cpp)
  if(sources)
    add_executable(test_${name} ${sources})
    target_include_directories(test_${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
    target_compile_definitions(test_${name} PRIVATE PLISSE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    target_link_libraries(test_${name} PRIVATE ${TESTS_LINKS} GTest::gtest_main plisse_compiler)
    gtest_discover_tests(test_${name} TEST_FILTER "-Slow*" DISCOVERY_TIMEOUT 60 PROPERTIES ENVIRONMENT "PLISSE_CACHE=")
    if(TESTS_HAS_SLOW)
      gtest_discover_tests(test_${name} TEST_FILTER "Slow*" DISCOVERY_TIMEOUT 60 PROPERTIES LABELS slow TIMEOUT 7200)
    endif()
  endif()
endfunction()
