# Compile flags shared by every target.
add_library(plisse_compiler INTERFACE)
target_compile_options(plisse_compiler INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wno-psabi)
# Contracted multiply-adds would make a predicate's sign, and with it a mesh, depend on the processor.
target_compile_options(plisse_compiler INTERFACE -ffp-contract=off)
if(PLISSE_NATIVE)
  target_compile_options(plisse_compiler INTERFACE -march=native)
endif()
if(PLISSE_SANITIZE)
  target_compile_options(plisse_compiler INTERFACE -fsanitize=${PLISSE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(plisse_compiler INTERFACE -fsanitize=${PLISSE_SANITIZE})
endif()
