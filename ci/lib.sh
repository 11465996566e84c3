# The functions that the checks share. Sourced: it moves to the crate's root and makes every error fatal.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Symbols are all that is looked at; with debug information, programs take twice as long to build.
export CARGO_PROFILE_RELEASE_DEBUG=0

say() { printf -- '-- %s\n' "$*" >&2; }

# need_program <program> <Debian package>: installs the package when the program is absent.
need_program() {
    command -v "$1" >/dev/null && return
    say "$1 is missing: installing the package $2"
    local root=()
    [ "$(id -u)" = 0 ] || root=(sudo)
    "${root[@]}" apt-get update -qq
    "${root[@]}" apt-get install -y -qq --no-install-recommends "$2" >/dev/null
}
need_qemu_arm() { need_program qemu-system-arm qemu-system-arm; }
need_qemu_riscv() { need_program qemu-system-riscv32 qemu-system-misc; }

# need_target <triple>...: installs the Rust targets that are absent.
need_target() {
    local installed triple
    installed=$(rustup target list --installed)
    for triple in "$@"; do
        grep -qx -- "$triple" <<<"$installed" && continue
        say "the Rust target $triple is missing: installing it"
        rustup target add "$triple"
    done
}

# llvm <tool>: the path of one of rustc's own LLVM tools, installing them when absent.
llvm() {
    local tool
    tool="$(rustc --print sysroot)/lib/rustlib/$(rustc -vV | sed -n 's/^host: //p')/bin/llvm-$1"
    if ! [ -x "$tool" ]; then
        say "llvm-$1 is missing: installing the component llvm-tools"
        rustup component add llvm-tools >&2
    fi
    echo "$tool"
}

# build <triple> <example> <file> [rustc flags]: builds a release example and copies it to <file>,
# because the next build with other flags overwrites it.
build() {
    local triple=$1 example=$2 file=$3 ext=
    shift 3
    [[ $triple == wasm32-* ]] && ext=.wasm
    cargo rustc -q --release --target "$triple" --example "$example" -- "$@"
    mkdir -p "$(dirname "$file")"
    cp "target/$triple/release/examples/$example$ext" "$file"
}

# memory <flash> <ram>: rustc flags for a chip with less of both than memory.x assumes.
memory() {
    printf -- '-Clink-arg=--defsym=_%s\n' "flash_length=$1" "ram_length=$2"
}

# emulate <machine> <image> [QEMU options]: runs an image until it exits; its prints arrive on stdout.
emulate() {
    local machine=$1 image=$2 qemu=(qemu-system-arm)
    shift 2
    [ "$machine" = virt ] && qemu=(qemu-system-riscv32 -bios none)
    timeout "${LIMIT:-300}" "${qemu[@]}" -machine "$machine" -nographic -monitor none \
        -semihosting-config enable=on,target=native "$@" -kernel "$image" </dev/null
}
