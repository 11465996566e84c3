# Sourced by ci/bench: counts a model of the user's own, an OBJ file of any polygons, on a screen of 320×240 that it fills:
# flat with face normals; Gouraud, with the file's normals or the means of the faces'; and where it has texture
# coordinates, with a checkerboard, as it is and lit. In one strip, and in 15 strips of 16 rows with records for all.
# Clearing is left out.
#
# tobj reads the file on the host; QEMU loads the words that are made of it into the emulated memory, so the firmware is
# the same for all models.

out=target/ci/model
mkdir -p "$out"

cargo run -q --release --example obj_bench -- "$model" "$out/model.bin" >"$out/host.txt"
awk '$1 == "flat" { exit $4 == 0 }' "$out/host.txt" ||
    say "no triangle of it faces the viewer: front faces go round against the clock"

for core in $looked_at; do
    build "${triple[$core]}" obj_bench "$out/$core"
    at=0x21000000
    [ "$core" != rv32imc ] || at=0x81000000
    count "$core" "$out/$core" -device "loader,file=$out/model.bin,addr=$at,force-raw=on" >"$out/$core.exact"
    awk 'NR == FNR { host[$1] = $6; next } host[$1] != $5 { print "-- " $1 ": not the picture of the host"; bad = 1 }
        END { exit bad }' "$out/host.txt" "$out/$core.exact" >&2
done

{
    printf 'core\tshader\tvertices\ttriangles\tdrawn\tpixels\tM insns, 1 strip\tmodel cycles\tM insns, 15 strips\tmodel cycles\n'
    for core in $looked_at; do
        awk -v core="$core" '
            function mega(n, empty) { return n == "-" ? "-" : sprintf("%.3f", (n - empty) / 1e6) }
            NR == FNR { if ($1 != "empty") { ways[++n] = $1 }; host[$1] = $2 "\t" $3 "\t" $4 "\t" $5; next }
            { insns[$1, $2] = $3; cycles[$1, $2] = $4 }
            END {
                for (k = 1; k <= n; k++) {
                    w = ways[k]; label = w; sub(/_/, ", ", label)
                    printf "%s\t%s\t%s", core, label, host[w]
                    for (rows = 240; rows >= 16; rows -= 224) printf "\t%s\t%s", \
                        mega(insns[w, rows], insns["empty", rows]), mega(cycles[w, rows], cycles["empty", rows])
                    print ""
                }
            }' "$out/host.txt" "$out/$core.exact"
    done
} | text
