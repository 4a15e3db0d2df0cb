"""Random mechanisms, by seed, that the two languages once counted differently, and what is right."""

APART_ONCE = {
    107: (5, 0),  # a shaft that a coupling slides; what turns on it is coupled elsewhere
    858: (6, 0),  # a coupling closes no loop
    2196: (6, 1),
    2850: (7, 0),  # two joints of one pair whose velocities, but no motion, go together
    3330: (0, 0),
    3630: (4, 1),
    3881: (3, 3),  # a coupling that holds two parts together, and leaves one loop
    4415: (5, 0),
    4821: (4, 1),
    4941: (3, 1),  # two branches of motions that touch each other
    5900: (2, 0),  # a coupling whose two joints became one
    5983: (4, 3),  # a leg at the pole of its universal joint
    6139: (0, 0),  # a velocity that is obstructed late
    6432: (6, 0),  # a coupling joins a chain's end to another chain
    6455: (2, 0),  # two branches, and an obstructed velocity that takes a motion back along with it
    11902: (5, 3),  # couplings that tie a slide, and leave its turn
    12243: (6, 3),
    30685: (2, 2),  # two idle spins, and a velocity obstructed at every pose
    72343: (4, 0),  # a steep coupling hid that a turn is obstructed
    60153: (2, 0),  # a block's only motion, in a part that a coupling makes larger
    60536: (7, 0),  # a screw that a rod holds by the square of its lead alone
    92355: (2, 1),  # a rack of a metre a degree hid that a loop has two motions
    94161: (3, 1),
    94743: (5, 5),  # a velocity that the fourth power of the way obstructs
    100278: (1, 0),  # a motion that turns back within a hundredth
    100916: (5, 0),
    101542: (3, 3),  # legs at the poles of their universal joints turn idly, unless the platform moves
    102298: (9, 6),  # a body with two velocities of which one goes on
    112508: (2, 1),  # a part that the source holds to another by a joint of its own
    113779: (6, 0),  # a trial step that does not come back onto the joints, and keeps its length for that alone
    303123: (3, 1),
    304118: (11, 1),  # a twist of two parts as one that is obstructed, beside an idle one of the first
    304555: (4, 2),  # branches that cross wherever a part stands still
    304853: (5, 4),
    307268: (11, 3),  # two twists of which one goes on
    316014: (3, 0),  # a loop's only motion, which a coupling ties to a slide outside of it
    318982: (9, 3),  # two parts whose common velocity is obstructed are one
    311658: (2, 0),  # a slide, and a turn that its fourth power obstructs
    314960: (5, 5),  # an obstructed velocity that takes a spin back along with it, so that only four were counted
    330848: (5, 5),
    338826: (5, 5),
    504242: (5, 5),
    504498: (5, 0),  # an obstructed turn whose coupling takes a slide back along with it
    502350: (0, 0),
    720456: (5, 4),  # two motions that differ by a screw's small lead
    752486: (2, 0),  # two branches that cross, onto which no step along mixtures leads
    752649: (6, 6),  # a rod's hinge, of which a universal joint holds but a rounding of the file
    2101210: (5, 5),  # five spins and an obstructed velocity: mixtures by a rule of few dimensions found three of them
    2203389: (6, 6),  # two branches that cross, where three mixtures happened to lie near one of them
    90882: (5, 5),  # obstructed velocities mixed with motions, which do not come back onto the joints in one go
    8102201: (5, 5),  # five spins, of which one and a platform's turn obstruct each other by the fourth power of a way along both
}
"""Mechanisms, by seed, that were once counted differently: mobility and idle freedoms."""

FEWEST_ROWS_APART_ONCE = {
    451735: (2, 0),  # two branches cross, of which a random step ends on the smaller one
    8300590: (7, 7),  # ten parts of 22 freedoms, of which the fourth power of the way obstructs a platform's turn
    9200780: (5, 1),  # motions end in a cusp, to one side of which no step closes
    9200819: (0, 0),  # a rack of half a metre a degree hid that its fourth power obstructs a turn
}
"""The same of mechanisms whose closing joints keep the fewest rows."""

BODIES_APART_ONCE = {
    13758: ("part3", 3, 3),  # 2e-4 beside the other five
    40144: ("high2", 1, 3),  # 8e-5 of its legs' speeds
    60637: ("top", 0, 1),
    50776: ("part1", 1, 1),  # a screw on a screw: 1e-6 of the others' speeds
    92734: ("low2", 0, 1),  # one motion of four has 2e-7 of it
    94911: ("top", 1, 2),
}
"""Bodies whose freedoms were once counted differently, by seed: translations and rotations.  Counted by rank with 60 digits."""
