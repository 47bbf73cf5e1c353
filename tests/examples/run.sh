#!/bin/sh
# Runs every example in a scratch directory and checks the result line that it prints, and the files of two_disks.
#   BUILD         where the built library lives; the examples are in $BUILD/examples (default: build)
#   EXAMPLES_RUN  those to run (default: all)
set -u

build=$(cd "${BUILD:-build}" && pwd) || exit 1
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
failures=0
ran=

fail() {
  echo "FAIL $*"
  failures=$((failures + 1))
}

# run name [arguments]: output to name.out, its result line to $result
run() {
  name=$1
  shift
  result=
  if ! "$build/examples/$name" "$@" >"$name.out" 2>"$name.err"; then
    fail "$name: exit status not 0"
    cat "$name.out" "$name.err"
    return
  fi
  result=$(tail -n 1 "$name.out")
  case $result in
  result:*) echo "$name: $result" ;;
  *)
    fail "$name: no result line at the end"
    cat "$name.out"
    ;;
  esac
}

# check "what" text low high: the number after `text` in the result line lies in [low, high]
check() {
  [ -n "$result" ] || return
  printf '%s\n' "$result" | awk -v what="$2" -v low="$3" -v high="$4" '
    {
      at = index($0, what)
      if (!at) exit 1
      rest = substr($0, at + length(what))
      if (!match(rest, /^ *[-+]?[0-9.]+([eE][-+]?[0-9]+)?/)) exit 1
      value = substr(rest, RSTART, RLENGTH) + 0
      exit !(value >= low && value <= high)
    }' || fail "$name: $1: the number after \"$2\" is not in [$3, $4]"
}

wanted() {
  case " ${EXAMPLES_RUN:-$1} " in
  *" $1 "*) ran="$ran $1 " ;;
  *) return 1 ;;
  esac
}

if wanted two_disks; then
  mkdir disks
  run two_disks disks
  check "least kinetic energy" "least kinetic energy" 0.05 0.2
  check "time of closest approach" "at t =" 1.98 2.13
  check "rebound" "rebound speed" 0.1222 0.1300 # that of contact_discs in docs/verification.md
  check "energy" "energy drift" -6 0
  check "momentum" "momentum at most" 0 1e-12
  for file in two_disks.pvd two_disks.svg two_disks_energy.svg energy.csv disk_a_0000.vtp disk_b_0036.vtp; do
    [ -s "disks/$file" ] || fail "two_disks: $file is missing or empty"
  done
  [ "$(awk -F, 'NF == 6' disks/energy.csv | wc -l)" -eq 362 ] || fail "two_disks: energy.csv has not 362 rows of 6 columns"
  if command -v python3 >/dev/null; then
    python3 - disks <<'PYTHON' || fail "two_disks: a file is not well-formed"
import glob, os, sys, xml.dom.minidom

where = sys.argv[1]
for name in ("two_disks.svg", "two_disks_energy.svg"):
    root = xml.dom.minidom.parse(os.path.join(where, name)).documentElement
    assert root.tagName == "svg" and root.getElementsByTagName("path"), name
series = xml.dom.minidom.parse(os.path.join(where, "two_disks.pvd"))
entries = series.getElementsByTagName("DataSet")
assert len(entries) == 74 == len(glob.glob(os.path.join(where, "disk_*.vtp"))), len(entries)
for entry in entries:
    with open(os.path.join(where, entry.getAttribute("file")), "rb") as f:
        data = f.read()
    # appended raw data is not XML: leave out what stands between "_" and the end of AppendedData
    begin = data.index(b"<AppendedData")
    begin = data.index(b">", begin) + 1
    end = data.rindex(b"</AppendedData>")
    root = xml.dom.minidom.parseString(data[:begin] + data[end:]).documentElement
    assert root.getAttribute("type") == "PolyData"
    names = {a.getAttribute("Name") for a in root.getElementsByTagName("DataArray")}
    assert {"velocity", "stress", "deformation_gradient"} <= names, names
PYTHON
  fi
fi

if wanted dam_break; then
  mkdir dam
  run dam_break dam
  check "front, at the slowest" "at least" -3 20
  check "front, at the fastest" "at most" 0 20
  for file in dam_break.pvd dam_break.svg dam_break_front.svg front.csv water_0000.vtp water_0011.vtp; do
    [ -s "dam/$file" ] || fail "dam_break: $file is missing or empty"
  done
  [ "$(awk -F, 'NF == 5' dam/front.csv | wc -l)" -eq 112 ] || fail "dam_break: front.csv has not 112 rows of 5 columns"
fi

if wanted taylor_bar; then
  mkdir taylor
  run taylor_bar taylor 3
  check "length" "length" 21.66 21.87
  check "foot" "foot radius" 7.07 7.21
  check "plastic strain" "plastic strain" 2.85 3.05
  awk '$1 == "80.0" { ended = 1; lost = $5 < 0.01 * start && $7 > 0.98 * start } $1 == "0.0" { start = $5 }
    END { exit !(ended && lost) }' taylor_bar.out || fail "taylor_bar: the plastic work is not the energy of the impact"
  for file in taylor_bar.svg taylor_bar.vtp; do
    [ -s "taylor/$file" ] || fail "taylor_bar: $file is missing or empty"
  done
fi

if wanted two_materials; then
  mkdir impact
  run two_materials impact
  check "squeeze of the block" "takes up to" 980 1080
  check "energy" "falls by" 6 12
  check "momentum" "momentum kept to" 0 1e-13
  check "angular momentum" "angular momentum to" 0 4e-4
  check "energies by set" "energy by sets to" 0 1e-9
  awk '$1 == "50.0" { flew = $2 < 60 && $3 > 1400; flow = $6 > 140 && $6 < 220; rows++ } END { exit !(rows == 1 && flew && flow) }' \
    two_materials.out || fail "two_materials: energies at the end are not those of a rebound with plastic flow"
  for file in ball.pvd block.pvd two_materials.svg ball_0000.vtp block_0020.vtp; do
    [ -s "impact/$file" ] || fail "two_materials: $file is missing or empty"
  done
fi

if wanted dropped_ball; then
  mkdir ball
  run dropped_ball ball
  check "momentum" "momentum off by" 0 1e-11
  check "deepest" "deepest" 0.05 0.1
  check "spin" "spin" -6 -1
  [ -s ball/dropped_ball.svg ] || fail "dropped_ball: dropped_ball.svg is missing or empty"
fi

if wanted snowball; then
  mkdir snow
  run snowball snow 24
  check "compaction" "result:" 70 95
  check "momentum" "momentum" -0.2 0
  [ -s snow/snowball.svg ] || fail "snowball: snowball.svg is missing or empty"
fi

if wanted stacked_blocks; then
  mkdir blocks
  run stacked_blocks blocks
  check "floor" "floor within" 0 1e-3
  check "lowest block" "moved by" -0.05 0.02
  check "blocks on the floor" "and" 0.8 1.1
  check "momentum" "momentum off by" 0 1e-11
  check "energy" "energy gained" -1 1e-3
  check "contact" "dissipation at least" 0 1
  [ -s blocks/stacked_blocks.svg ] || fail "stacked_blocks: stacked_blocks.svg is missing or empty"
fi

if wanted stl_body; then
  mkdir knot
  run stl_body knot
  check "volume" "volume within" 0 0.5
  check "floor" "lowest" 0 0.02
  check "rebound" "thrown back with" 0.2 1.5
  [ -s knot/stl_body.svg ] || fail "stl_body: stl_body.svg is missing or empty"
fi

if wanted inflated_tube; then
  mkdir tube
  run inflated_tube tube
  check "stretch of the inner face" "stretch" 2.2 2.3
  check "pressure" "pressure within" 0 3.5
  [ -s tube/inflated_tube.svg ] || fail "inflated_tube: inflated_tube.svg is missing or empty"
fi

if wanted swinging_saddle; then
  mkdir saddle
  run swinging_saddle saddle
  check "angle" "angle within" 0 0.05
  check "energy" "pendulum," 0 5
  check "mean force" "mean force" 1450 1600
  [ -s saddle/swinging_saddle.svg ] || fail "swinging_saddle: swinging_saddle.svg is missing or empty"
fi

if wanted rubber_strap; then
  mkdir strap
  run rubber_strap strap
  check "length" "drawn to" 3 3
  check "force" "force" 1750 1785
  check "largest stretch" "largest stretch" 5.4 5.8
  [ -s strap/rubber_strap.svg ] || fail "rubber_strap: rubber_strap.svg is missing or empty"
  run rubber_strap strap 0
  check "length where weights follow from present positions" "drawn to" 1.5 2.5
fi

if wanted bimetal; then
  mkdir bimetal
  run bimetal bimetal
  check "deflection over Timoshenko's" "of Timoshenko's" 0.97 1.06
  check "balance" "missing in the balance" 0 1e-9
  [ -s bimetal/bimetal.svg ] || fail "bimetal: bimetal.svg is missing or empty"
fi

if wanted rubber_band; then
  mkdir band
  run rubber_band band
  check "stretch" "drawn to" 2.85 2.87
  check "force" "with" 340 365
  check "force beside that of a thin band" "kN per m," -12 -7
  check "particles" "by" 1500 3000
  check "way without splitting" "after" 0.8 1.4
  [ -s band/rubber_band.svg ] || fail "rubber_band: rubber_band.svg is missing or empty"
fi

if wanted rolling_disc; then
  mkdir slope
  run rolling_disc slope 12
  check "way" "result: way" 0.97 1.01
  check "turn" "turn" 0.96 1.0
  check "friction" "friction" 0.98 1.05
  check "normal force" "normal force" 0.97 1.02
  check "energy" "energy lost" 0 4
  [ -s slope/rolling_disc.svg ] || fail "rolling_disc: rolling_disc.svg is missing or empty"
fi

if wanted four_discs; then
  mkdir discs
  run four_discs discs 20
  check "last disc" "last disc has" 0.94 0.97
  check "last disc, implicit" "with implicit steps" 0.93 0.96
  check "shares" "differ by" 0 0.03
  check "momentum" "momentum off by" 0 1e-12
  check "energy" "explicit energy at most" 0.98 1.0005
  check "energy at the end" "at the end" 0.985 1.0
  check "energy, implicit" "implicit energy at most" 0.98 1.0005
  check "energy at the end, implicit" "in the end" 0.94 0.98
  check "stresses" "correlate to" 0.97 1
  [ -s discs/four_discs.svg ] || fail "four_discs: four_discs.svg is missing or empty"
fi

if wanted outflow; then
  mkdir channel
  run outflow channel
  check "particles that left" "result:" 2380 2450
  check "mass balance" "mass balance to" 0 1e-11
  check "flux" "outlet" 0.985 1.01
  check "depth" "depth within" 0 2
  check "speed" "speed within" 0 1
  for file in outflow.pvd outflow_grid.pvd outflow.svg water_0001.vtp water_0020.vtp grid_0020.vti; do
    [ -s "channel/$file" ] || fail "outflow: $file is missing or empty"
  done
fi

if wanted sand_column; then
  mkdir column
  run sand_column column 8
  check "run-out" "result: run-out" 1.0 1.2
  check "run-out beside experiments" "the radius," 0.7 1.3
  check "height" "height" 0.7 0.8
  check "volume" "volume" 1.0 1.15
  for file in sand_column.svg sand_column.vtp; do
    [ -s "column/$file" ] || fail "sand_column: $file is missing or empty"
  done
fi

if wanted circular_footing; then
  mkdir footing
  run circular_footing footing 12
  check "pressure over the exact one" "s_u," 1.0 1.15
  [ -s footing/circular_footing.svg ] || fail "circular_footing: circular_footing.svg is missing or empty"
fi

if wanted hourglass; then
  mkdir sand
  run hourglass sand 4
  check "all sand passes" "result: passed" 0.97 1
  check "time" "at t =" 2.0 2.7
  check "steady rate" "later" 0.8 1.1
  [ -s sand/hourglass.svg ] || fail "hourglass: hourglass.svg is missing or empty"
fi

if wanted slope_failure; then
  mkdir failure
  run slope_failure failure 16
  check "gravity at failure" "fails at" 0.8 0.95
  check "crest" "crest sinks by" 4.5 5.5
  check "toe" "toe goes" 8 10.5
  check "strain of the bands" "plastic strain" 6.5 9.5
  [ -s failure/slope_failure.svg ] || fail "slope_failure: slope_failure.svg is missing or empty"
fi

if wanted cantilever; then
  run cantilever
  check "deviation from FEM" "deviation" -4 4
  awk '$5 == "%" && ($4 > 4 || $4 < -4) && $1 <= 0.9 && $1 > 0.1 { bad = 1 } $5 == "%" { rows++ } END { exit bad || rows != 10 }' \
    cantilever.out || fail "cantilever: more than 4 % from FEM before t = 0.9, or not 10 rows"
fi

if wanted user_material; then
  run user_material
  check "own law against the built-in" "from the built-in by" 0 1e-10
  check "visco-elastic bar" "from theory by" 0 1
fi

if wanted user_force_and_boundary; then
  run user_force_and_boundary
  check "wall force" "wall force" -0.0712 -0.0688
  check "grip force" "grip force" 0.0255 0.0265
  check "energy balance" "energy balance" -1 1
fi

if wanted host_threads; then
  run host_threads
  check "hashes" "result:" 4 4
fi

if wanted staged_coupling; then
  run staged_coupling
  check "period" "deviation" -1.5 1.5
  check "momentum" "momentum kept to" 0 1e-11
  check "energy" "energy of vibration to" 0 3
fi

if wanted cholmod_solver && [ -e "$build/examples/cholmod_solver" ]; then
  run cholmod_solver
  check "same as the built-in solver" "differ by" 0 1e-9
  check "tip" "sinks by" 1.5 1.65
fi

if wanted petsc_solver && [ -e "$build/examples/petsc_solver" ]; then
  for option in "" -locking_remedy; do
    run petsc_solver -cells 8 $option
    check "same as the built-in solvers" "differ by" 0 1e-10
    check "solves" "patterns for" 6 12
  done
fi

if wanted indenter; then
  mkdir indenter
  run indenter indenter 8
  check "force of the steel sphere" "result: steel" 82 85.5
  check "ratio to Hertz" "N," 1.38 1.45
  check "force of the rubber sphere" "; rubber" 56 59
  check "balance" "balance to" 0 1e-10
  awk '$1 == "5.000" { found = $4 > 1.4 && $4 < 1.6 && $7 > 1.75 && $7 < 1.95 } END { exit !found }' indenter.out ||
    fail "indenter: ratios to Hertz on the way are not as measured"
  [ "$(awk -F, 'NF == 5' indenter/force.csv | wc -l)" -eq 11 ] || fail "indenter: force.csv has not 11 rows of 5 columns"
  for file in block.pvd sphere.pvd soft_block.pvd soft_sphere.pvd block_0000.vtp soft_sphere_0010.vtp; do
    [ -s "indenter/$file" ] || fail "indenter: $file is missing or empty"
  done
fi

if wanted cpp_block; then
  run cpp_block
  check "settlement" "settlement" 4.1 4.2
  check "statics" "from theory by" 0 1
  check "weight" "from weight by" 0 0.01
fi

for name in ${EXAMPLES_RUN:-two_disks}; do
  case "$ran" in
  *" $name "*) ;;
  *) fail "$name: nothing was run" ;;
  esac
done
[ "$failures" -eq 0 ] || {
  echo "$failures checks of the examples failed"
  exit 1
}
echo "examples: all checks passed"
