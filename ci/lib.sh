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

# The cores that instructions are counted on. On Arm, an instruction takes 8 ns under -icount, so SysTick at 25 MHz ticks
# once in 5 of them; on RISC-V, it takes 1 ns, so `minstret`, which counts nanoseconds then, counts instructions.
declare -A triple=([m0+]=thumbv6m-none-eabi [m4]=thumbv7em-none-eabihf [rv32imc]=riscv32imc-unknown-none-elf)
declare -A machine=([m0+]=mps2-an385 [m4]=mps2-an386 [rv32imc]=virt)
declare -A icount=([m0+]=3 [m4]=3 [rv32imc]=0)
declare -A plugin_core=([m0+]=0 [m4]=4)
core_names='m0+ m4 rv32imc'

# need_cores <core>...: what it takes to count on them.
need_cores() {
    local core
    for core in "$@"; do
        [ -n "${triple[$core]:-}" ] || { say "no core $core: there are $core_names"; exit 2; }
        if [ "$core" = rv32imc ]; then need_qemu_riscv; else need_qemu_arm; fi
        need_target "${triple[$core]}"
    done
}

# count <core> <image> [QEMU options]: runs firmware that prints lines `name run ticks ...`, and prints them as
# `name run instructions cycles ...`. With $plugin, the path of a QEMU plugin, instructions are exact, and there are
# model cycles; otherwise these are `-`. With $by_address, the plugin counts at each address, too: <image>.count.pc.
count() {
    local core=$1 image=$2 options=()
    shift 2
    if [ -n "${plugin:-}" ] && [ "$core" != rv32imc ]; then
        options=(-plugin "$plugin,out=$image.count,core=${plugin_core[$core]}${by_address:+,pc=on}")
    fi
    emulate "${machine[$core]}" "$image" -icount "shift=${icount[$core]},sleep=off,align=off" "${options[@]}" "$@" \
        >"$image.txt"
    if [ -n "${options[*]}" ]; then
        # A run without a count would get that of the next one.
        if [ "$(grep -c '^REGION ' "$image.count")" != "$(grep -c . "$image.txt")" ]; then
            say "$image: the plugin has missed a run: $(grep -c '^REGION ' "$image.count") of $(grep -c . "$image.txt")"
            return 1
        fi
        awk 'NR == FNR { split($3, n, "="); split($4, c, "="); if ($1 == "REGION") count[$2] = n[2] " " c[2]; next }
            { $3 = count[FNR - 1]; print }' "$image.count" "$image.txt"
    else
        awk -v times="$([ "$core" = rv32imc ] && echo 1 || echo 5)" '{ $3 = times * $3 " -"; print }' "$image.txt"
    fi
}

# markdown: makes a table of tab-separated lines, the first of which are headings. Columns whose first cell is a number
# are aligned to the right; whole numbers get commas.
markdown() {
    awk -F '\t' '
        function cell(c) {
            if (c ~ /^[0-9][0-9][0-9][0-9]+$/) while (match(c, /[0-9][0-9][0-9][0-9]($|,)/))
                c = substr(c, 1, RSTART) "," substr(c, RSTART + 1)
            return c
        }
        function row(line,    part, n, i, text) {
            n = split(line, part, "\t")
            for (i = 1; i <= n; i++) text = text "| " cell(part[i]) " "
            return text "|"
        }
        NR == 1 { headings = $0; next }
        NR == 2 {
            print row(headings)
            for (i = 1; i <= NF; i++) printf $i ~ /^[-+×0-9.]+/ ? "|--:" : "|---"
            print "|"
        }
        { print row($0) }'
}

# write_table <document> <name>: puts standard input between the lines `<!-- <name> -->` and `<!-- end -->`.
write_table() {
    local document=$1 name=$2 new
    new=$(mktemp)
    grep -qxF "<!-- $name -->" "$document" || { say "$document has no table $name"; exit 1; }
    awk -v start="<!-- $name -->" '
        NR == FNR { table = table $0 "\n"; next }
        $0 == start { print; printf "\n%s\n", table; skip = 1; next }
        skip && $0 == "<!-- end -->" { skip = 0 }
        !skip' - "$document" >"$new"
    cat "$new" >"$document"
    rm "$new"
}

# text: aligns tab-separated lines; columns of numbers to the right.
text() {
    awk -F '\t' '
        { for (i = 1; i <= NF; i++) { cell[NR, i] = $i; n = length($i); if (n > width[i]) width[i] = n }
          if (NF > columns) columns = NF }
        END {
            for (r = 1; r <= NR; r++) {
                line = ""
                for (i = 1; i <= columns; i++) {
                    # The second row tells what a column has.
                    right = cell[2, i] ~ /^[-+×0-9.]+/
                    line = line sprintf("%" (right ? "" : "-") width[i] "s  ", cell[r, i])
                }
                sub(/ +$/, "", line)
                print line
            }
        }'
}
