# Compile flags shared by every target.
add_library(plisse_compiler INTERFACE)
target_compile_options(plisse_compiler INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wno-psabi)
# Contracted multiply-adds would make a predicate's sign, and with it a mesh, depend on the processor.
target_compile_options(plisse_compiler INTERFACE -ffp-contract=off)
if(PLISSE_NATIVE)
  # Without AVX-512: no gain for blocks of three, and GCC 12 warns about its own intrinsics.
  target_compile_options(plisse_compiler INTERFACE -march=native -mno-avx512f)
endif()
if(PLISSE_SANITIZE)
  target_compile_options(plisse_compiler INTERFACE -fsanitize=${PLISSE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(plisse_compiler INTERFACE -fsanitize=${PLISSE_SANITIZE})
endif()
