#!/usr/bin/env python3
"""What a step of several machines would take: a model, with what one machine has measured. Prints the tables of
docs/distributed.md. 3-D, quadratic splines, MPM_USL, MPM_FLIP, 8 particles per cell.

A step is the work of a part's particles, packing what is exchanged, the exchange less what blocks
hide that nobody waits for, adding what has come, reductions, and a thirtieth of a sort, in which particles
move and now and then blocks are given to parts anew."""
import functools
import itertools
import math

# Measured. Of the part that sends most, the mean of a fresh and a loose sort (make measure-parts, and SIDE=3 CELLS=48):
# bytes that it sends in a step, by particles per part.
SENT = {110592: 3.92e6, 884736: 12.4e6}
PER_BLOCK = 1528.0  # particles of a block in the second of these runs
NEIGHBOURS = 22
REDUCTIONS = 5  # in a step, counted by the transport
PARTICLE = 70e-9  # seconds per particle and step on one core: 3-D quadratic FLIP on a Zen 4 at 3.65 GHz
PACKING = 0.19e-9  # seconds per byte on one core: dam_break_mpi 48 2 on two processes of two cores
ADDING = 0.83e-9  # seconds per byte that has come, by clocks around it in the same run
MOVING = 1.5e-9  # seconds per byte of a particle that moves, packed and unpacked on one core: dam_break_mpi 36 20, likewise
SCANNING = 8e-9  # seconds per particle, by one thread, to find those that move
SORT_REDUCTIONS = 10  # in a sort with its two sparse exchanges, counted in the sources
CUT_REDUCTIONS = 63  # in a cut, at most: one for each bit of a key
SORT_ALONE = 33e-9  # seconds per particle in a sort, by one thread and by what threads share: 70 and 52 on one and two (make bench)
SORT_SHARED = 37e-9

# Assumed: nothing of this has been measured.
THREADS = 0.75  # what 16 threads of a part lose to each other: 12 times the rate of one, in copying as in steps
STAYS = 0.4  # share of the bytes that goes to processes of the same machine, where it has several
HIDES = 0.4  # share of a block's work that its sums are
CUTS = 0.1  # cuts per sort, made or looked for
MIGRATES = 0.06 * 400.0  # bytes per particle in a sort
NETWORKS = {  # latency, bytes per second of a machine each way, cores of a machine; a part has 16 of them
    "A": (2e-6, 25e9, 128),
    "B": (20e-6, 12.5e9, 96),
    "C": (30e-6, 1.25e9, 16),
}
CORES = 16


def sent_by(n):
    """Bytes that a part sends, by a power law through the two measured sizes."""
    (small, a), (large, b) = SENT.items()
    return a * (n / small) ** (math.log(b / a) / math.log(large / small))


@functools.lru_cache(None)
def early_share(n, parts=27):
    """The share of a part's blocks that give before messages have come (src/parallel/early.c), where so many parts have the
    blocks of a cube in Morton order. Of 884 736 particles 41 % of the blocks are not on the boundary and 29 % of these early
    when that is counted in a run of make measure-parts, 39 and 33 % here."""
    side = round((parts * n / PER_BLOCK) ** (1 / 3))

    def key(block):
        return sum((block[axis] >> bit & 1) << (3 * bit + 2 - axis) for bit in range(10) for axis in range(3))

    def colour(block):
        return 4 * (block[0] & 1) + 2 * (block[1] & 1) + (block[2] & 1)

    blocks = sorted(itertools.product(range(side), repeat=3), key=key)
    owner = {block: i * parts // len(blocks) for i, block in enumerate(blocks)}
    steps = list(itertools.product((-1, 0, 1), repeat=3))
    beside = {(x, y, z): [near for near in ((x + i, y + j, z + k) for i, j, k in steps) if near in owner] for x, y, z in blocks}
    late = {block: any(owner[near] != owner[block] for near in beside[block]) for block in blocks}
    inner = sorted((block for block in blocks if not late[block]), key=colour)
    for block in inner:
        late[block] = any(late[near] and colour(near) < colour(block) for near in beside[block])
    return sum(not late[block] for block in inner) / len(blocks)


def threads_for(size):
    """The rate of the threads that share a copy of so many bytes, over that of one."""
    return min(CORES * THREADS, 1.0 + size / 65536.0)


def step(n, parts, network):
    latency, bandwidth, cores = NETWORKS[network]
    work = n * PARTICLE / (CORES * THREADS)
    sort = (SORT_ALONE + SORT_SHARED / (CORES * THREADS)) * n / 30.0
    if parts == 1:
        return work + sort
    beside = cores // CORES
    leaves = 1.0 if beside == 1 else 1.0 - STAYS
    sent = sent_by(n)
    exchange = NEIGHBOURS * latency + leaves * sent * beside / bandwidth
    reduce = REDUCTIONS * 2.0 * latency * math.ceil(math.log2(parts))
    moves = MIGRATES * n
    levels = math.ceil(math.log2(parts))
    together = 2.0 * levels * (SORT_REDUCTIONS * latency + CUTS * CUT_REDUCTIONS * (latency + 8.0 * parts / bandwidth))
    sort += (SCANNING * n + MOVING * moves / threads_for(moves / NEIGHBOURS) + moves * beside * leaves / bandwidth + 2 * NEIGHBOURS * latency + together) / 30.0
    copying = (PACKING / threads_for(sent) + ADDING / (CORES * THREADS)) * sent
    return work + copying + max(0.0, exchange - HIDES * early_share(n) * work) + reduce + sort


def table(cases):
    print("| | " + " | ".join(NETWORKS) + " |\n|---|" + "---|" * len(NETWORKS))
    for name, n, parts in cases:
        cells = []
        for network in NETWORKS:
            took = step(n, parts, network)
            cells.append(f"{1e3 * took:.1f} ({100 * step(n, 1, network) / took:.0f} %)")
        print(f"| {name} | " + " | ".join(cells) + " |")


if __name__ == "__main__":
    table([(f"10⁶ particles on each of {parts:,} parts".replace(",", " "), 10 ** 6, parts) for parts in (8, 1000, 10000)]
          + [(f"10⁹ particles on {parts:,} parts".replace(",", " "), 10 ** 9 // parts, parts) for parts in (250, 1000, 4000, 10000)]
          + [("10¹⁰ particles on 2 500 parts", 4 * 10 ** 6, 2500)])
