# Sourced by ./demo and ./test. build PRESET [TARGET...]: configures and builds build/PRESET, all targets by default.
build() {
    local preset=$1
    shift
    local options=()
    if command -v ccache > /dev/null; then
        options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    fi
    cmake --preset "$preset" "${options[@]}"
    cmake --build "build/$preset" --parallel "$(nproc)" ${1:+--target "$@"}
}
