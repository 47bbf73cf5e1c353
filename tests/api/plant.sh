#!/usr/bin/env bash
# The planter of faults (tests/mutate/plant.py) on a source of its own: an expression is found in its function however it is
# written and in whatever file, and refused where it is missing or stands twice.
set -euo pipefail
scratch=${MPM_SCRATCH:-${BUILD:-build}/tests/scratch}/plant
planter=$PWD/tests/mutate/plant.py
rm -rf "$scratch"
mkdir -p "$scratch/src/part" "$scratch/include/mpm" "$scratch/tests/mutate"
cd "$scratch"

cat > src/part/one.c << 'END'
#define LIMIT(x) \
  ((x) > 3 ? \
   3 : (x))
enum { MOST = 7 };
EACH(one, two)
static int first(int a, int b) { return a + /* why { */ b; }
int KERNEL(second)(int a) {
#if A {
  const char *text = "a + b }";
#endif
  if (a) { return a
    + b; }
  return a * a;
}
static const int table[] = {1, MOST, 3};
static int twice(void) { return 2; }
END
echo 'static int twice(void) { return 2; }' > src/part/three.c
cat > include/mpm/two.hpp << 'END'
namespace mpm {
template <typename T> class view : public base<T> {
public:
  explicit view(T t) : kept_{t}, more_(t) { keep(t); }
  ~view() { drop(t); }
  bool operator==(const view &o) const noexcept { return kept_ == o.kept_; }
};
} // namespace mpm
END

plant() { # a fault; prints what changed
  rm -rf was
  cp -r src was
  cp -r include was
  printf '%s\n' "$@" > tests/mutate/faults.txt
  local status=0
  python3 "$planter" check > checked && python3 "$planter" plant 0 > /dev/null || status=$?
  diff -r src was | sed -n 's/^< *//p'
  diff -r include was/include | sed -n 's/^< *//p'
  cp was/part/one.c src/part/one.c
  cp was/include/mpm/two.hpp include/mpm/two.hpp
  return $status
}
gives() { # what comes out, the fault
  local out
  out=$(plant "${@:2}") || { cat checked; echo "plant.sh: refused: ${*:2}" >&2; exit 1; }
  [ "$out" = "$1" ] || { printf 'plant.sh: %s\ngives %s\nand not %s\n' "${*:2}" "$out" "$1" >&2; exit 1; }
}
refuses() {
  if plant "$@" > out; then cat out; echo "plant.sh: taken: $*" >&2; exit 1; fi
}

gives 'static int first(int a, int b) { return a - b; }' 's first' '- a+b' '+ a - b'
gives 'static int first(int a, int b) { return 0; }' 's src/gone/away.c first' '- a + b' '+ 0'
gives 'if (a) { return b; }' 's second' '- a + b' '+ b'
gives 'if (a) { ; }' 's second' '- return a + b;' '+ ;'
gives '((x) >= 3 ? \' 's -' '- (x) > 3' '+ (x) >= 3'
gives 'enum { MOST = 8 };' 's src/part/one.c -' '- MOST = 7' '+ MOST = 8'
gives 'static const int table[] = {1, 2, 3};' 's -' '- {1, MOST' '+ {1, 2'
gives 'static int first( int b) { return  /* why { */ b; }' 's first' '- int a,' '+' '- a +' '+'
gives 'explicit view(T t) : kept_{t}, more_(t) {  }' 's view' '- keep(t);' '+'
gives '~view() {  }' 's ~view' '- drop(t);' '+'
gives 'bool operator==(const view &o) const noexcept { return kept_ != o.kept_; }' 's operator==' '- kept_ ==' '+ kept_ !='
gives 'static int twice(void) { return 3; }' 's src/part/one.c twice' '- 2' '+ 3'
refuses 's twice' '- 2' '+ 3'
refuses 's second' '- a' '+ b'
refuses 's second' '- a * b' '+ b'
refuses 's first' '- a * a' '+ 0'
refuses 's third' '- a + b' '+ 0'
refuses 's EACH' '- a + b' '+ 0'
refuses 's -' '- a + b' '+ 0'
echo "the planter finds what it must, and refuses the rest"
