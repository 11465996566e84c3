# Sourced by ci/bench: counts W4, W5, W6, W9 and W10 by shaders of a user's own, and in states that are not the default,
# and prints what they cost more than as the benchmark draws them. It shows that no budget is met by a path that only the
# benchmark takes. tests/price.rs compares the pictures.
#
# Passed on: a wrapper of one's own that forwards every function. Own fragment: a wrapper that has a fragment function
# and no other. LessEqual, biased, all faces: the benchmark's shader in such a state; all faces draws the back faces
# too, so triangles drawn are beside it. W9 has light in one channel; coloured, it has three. Blended: an opaque `Blend`, which reads each pixel.

out=target/ci/price
rm -rf "$out"
mkdir -p "$out"

for core in $looked_at; do
    build "${triple[$core]}" price "$out/$core"
    count "$core" "$out/$core" >"$out/$core.exact"
done

# The pictures of a workload that is passed on, and those on all cores, are equal.
for core in $looked_at; do cat "$out/$core.exact"; done | awk '
    $2 == "usual" { usual = $NF }
    $2 == "passed_on" && $NF != usual { print "-- " $1 " passed on: not the usual picture"; bad = 1 }
    ($1, $2) in hash && hash[$1, $2] != $NF { print "-- " $1 " " $2 ": another picture on another core"; bad = 1 }
    { hash[$1, $2] = $NF }
    END { exit bad }' >&2

{
    printf 'core\tworkload\tunit\tusual\tpassed on\town fragment\tLessEqual\tbiased\tblended\tall faces\tdrawn\n'
    for core in $looked_at; do
        awk -v core="$core" '
            $1 ~ /^empty/ { empty[$1] = $3; next }
            {
                n = $3 - empty[$1 ~ /^w(9|10)/ ? "empty_spot" : "empty"]
                if (!(($1, "usual") in insns)) { name[++names] = $1 }
                insns[$1, $2] = n; drawn[$1, $2] = $5
            }
            END {
                ways = split("passed_on own_fragment less_equal biased blended all_faces", way, " ")
                for (k = 1; k <= names; k++) {
                    w = name[k]; usual = insns[w, "usual"]
                    label = w; sub(/^w/, "W", label); sub(/_/, ", ", label)
                    line = core "\t" label "\t" (w == "w6" ? "insns/triangle" : "M insns/frame") "\t" \
                        (w == "w6" ? sprintf("%.0f", usual / 10000) : sprintf("%.3f", usual / 1e6))
                    for (j = 1; j <= ways; j++) {
                        percent = sprintf("%+.0f", 100 * (insns[w, way[j]] / usual - 1))
                        line = line "\t" (percent == "-0" ? "+0" : percent) " %"
                    }
                    print line sprintf("\t×%.2f", drawn[w, "all_faces"] / drawn[w, "usual"])
                }
            }' "$out/$core.exact"
    done
} >"$out/prices"

echo "Prices: what workloads cost more by shaders of a user's own, and in other states"
text <"$out/prices"
[ "$write" = 0 ] || markdown <"$out/prices" | write_table docs/speed.md "ci/bench --write: prices"
