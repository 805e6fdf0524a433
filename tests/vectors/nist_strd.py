#!/usr/bin/env python3
"""Writes nist_strd.json: the eleven data sets of linear regression of NIST's Statistical Reference Datasets, with their
certified values.

It solves each set in rational arithmetic and refuses to write a certified value that differs from the solution in any of
its 15 digits, so no typing error in the data or in a certified value can pass. Needs Python alone.
"""

import json
import sys
from decimal import Decimal, localcontext
from fractions import Fraction
from pathlib import Path

NORRIS_Y = """
0.1 338.8 118.1 888.0 9.2 228.1 668.5 998.5 449.1 778.9 559.2 0.3 0.1 778.1 668.8 339.3 448.9 10.8 557.7 228.3 998.0
888.8 119.6 0.3 0.6 557.6 339.3 888.0 998.5 778.9 10.2 117.6 228.9 668.4 449.2 0.2
"""
NORRIS_X = """
0.2 337.4 118.2 884.6 10.1 226.5 666.3 996.3 448.6 777.0 558.2 0.4 0.6 775.5 666.9 338.0 447.5 11.6 556.0 228.1
995.8 887.6 120.2 0.3 0.3 556.8 339.1 887.2 999.0 779.0 11.1 118.3 229.2 669.1 448.9 0.5
"""
PONTIUS_Y = """
0.11019 0.21956 0.32949 0.43899 0.54803 0.65694 0.76562 0.87487 0.98292 1.09146 1.20001 1.30822 1.41599 1.52399
1.63194 1.73947 1.84646 1.95392 2.06128 2.16844 0.11052 0.22018 0.32939 0.43886 0.54798 0.65739 0.76596 0.87474
0.98300 1.09150 1.20004 1.30818 1.41613 1.52408 1.63159 1.73965 1.84696 1.95445 2.06177 2.16829
"""
FILIP_Y = """
0.8116 0.9072 0.9052 0.9039 0.8053 0.8377 0.8667 0.8809 0.7975 0.8162 0.8515 0.8766 0.8885 0.8859 0.8959 0.8913
0.8959 0.8971 0.9021 0.909 0.9139 0.9199 0.8692 0.8872 0.89 0.891 0.8977 0.9035 0.9078 0.7675 0.7705 0.7713 0.7736
0.7775 0.7841 0.7971 0.8329 0.8641 0.8804 0.7668 0.7633 0.7678 0.7697 0.77 0.7749 0.7796 0.7897 0.8131 0.8498 0.8741
0.8061 0.846 0.8751 0.8856 0.8919 0.8934 0.894 0.8957 0.9047 0.9129 0.9209 0.9219 0.7739 0.7681 0.7665 0.7703 0.7702
0.7761 0.7809 0.7961 0.8253 0.8602 0.8809 0.8301 0.8664 0.8834 0.8898 0.8964 0.8963 0.9074 0.9119 0.9228
"""
FILIP_X = """
-6.860120914 -4.324130045 -4.358625055 -4.358426747 -6.955852379 -6.661145254 -6.355462942 -6.118102026 -7.115148017
-6.815308569 -6.519993057 -6.204119983 -5.853871964 -6.109523091 -5.79832982 -5.482672118 -5.171791386 -4.851705903
-4.517126416 -4.143573228 -3.709075441 -3.499489089 -6.300769497 -5.953504836 -5.642065153 -5.031376979 -4.680685696
-4.329846955 -3.928486195 -8.56735134 -8.363211311 -8.107682739 -7.823908741 -7.522878745 -7.218819279 -6.920818754
-6.628932138 -6.323946875 -5.991399828 -8.781464495 -8.663140179 -8.473531488 -8.247337057 -7.971428747 -7.676129393
-7.352812702 -7.072065318 -6.774174009 -6.478861916 -6.159517513 -6.835647144 -6.53165267 -6.224098421 -5.910094889
-5.598599459 -5.290645224 -4.974284616 -4.64454848 -4.290560426 -3.885055584 -3.408378962 -3.13200249 -8.726767166
-8.66695597 -8.511026475 -8.165388579 -7.886056648 -7.588043762 -7.283412422 -6.995678626 -6.691862621 -6.392544977
-6.067374056 -6.684029655 -6.378719832 -6.065855188 -5.752272167 -5.132414673 -4.811352704 -4.098269308 -3.66174277
-3.2644011
"""
# y and six predictors in each line.
LONGLEY = """
60323 83 234289 2356 1590 107608 1947
61122 88.5 259426 2325 1456 108632 1948
60171 88.2 258054 3682 1616 109773 1949
61187 89.5 284599 3351 1650 110929 1950
63221 96.2 328975 2099 3099 112075 1951
63639 98.1 346999 1932 3594 113270 1952
64989 99 365385 1870 3547 115094 1953
63761 100 363112 3578 3350 116219 1954
66019 101.2 397469 2904 3048 117388 1955
67857 104.6 419180 2822 2857 118734 1956
68169 108.4 442769 2936 2798 120445 1957
66513 110.8 444546 4681 2637 121950 1958
68655 112.6 482704 3813 2552 123366 1959
69564 114.2 502601 3931 2514 125368 1960
69331 115.7 518173 4806 2572 127852 1961
70551 116.9 554894 4007 2827 130081 1962
"""
WAMPLER1_Y = """
1 6 63 364 1365 3906 9331 19608 37449 66430 111111 177156 271453 402234 579195 813616 1118481 1508598 2000719
2613660 3368421
"""
WAMPLER2_Y = """
1.00000 1.11111 1.24992 1.42753 1.65984 1.96875 2.38336 2.94117 3.68928 4.68559 6.00000 7.71561 9.92992 12.75603
16.32384 20.78125 26.29536 33.05367 41.26528 51.16209 63.00000
"""
WAMPLER3_Y = """
760 -2042 2111 -1684 3888 1858 11379 17560 39287 64382 113159 175108 273291 400186 581243 811568 1121004 1506550
2002767 2611612 3369180
"""
WAMPLER4_Y = """
75901 -204794 204863 -204436 253665 -200894 214131 -185192 221249 -138370 315911 -27644 455253 197434 783995 608816
1370781 1303798 2205519 2408860 3444321
"""
WAMPLER5_Y = """
7590001 -20479994 20480063 -20479636 25231365 -20476094 20489331 -20460392 18417449 -20413570 20591111 -20302844
18651453 -20077766 21059195 -19666384 26348481 -18971402 22480719 -17866340 10958421
"""


def one(text):
    """Rows of one predictor."""
    return [[word] for word in text.split()]


def rows(text):
    return [line.split() for line in text.strip().splitlines()]


def polynomial(degree):
    return [[0, power] for power in range(degree + 1)]


LOADS = one(" ".join(str(150000 * load) for load in range(1, 21)))
COUNTS = one(" ".join(map(str, range(21))))
# Name, predictors in each row, y, terms (predictor and power), certified estimates, their certified standard deviations,
# certified residual standard deviation.
SETS = [
    ("Norris", one(NORRIS_X), NORRIS_Y, polynomial(1),
     "-0.262323073774029 1.00211681802045",
     "0.232818234301152 0.429796848199937E-03",
     "0.884796396144373"),
    ("Pontius", LOADS + LOADS, PONTIUS_Y, polynomial(2),
     "0.673565789473684E-03 0.732059160401003E-06 -0.316081871345029E-14",
     "0.107938612033077E-03 0.157817399981659E-09 0.486652849992036E-16",
     "0.205177424076185E-03"),
    ("NoInt1", one(" ".join(map(str, range(60, 71)))), " ".join(map(str, range(130, 141))), [[0, 1]],
     "2.07438016528926",
     "0.165289256198347E-01",
     "3.56753034006338"),
    ("NoInt2", one("4 5 6"), "3 4 4", [[0, 1]],
     "0.727272727272727",
     "0.420827318078432E-01",
     "0.369274472937998"),
    ("Filip", one(FILIP_X), FILIP_Y, polynomial(10),
     "-1467.48961422980 -2772.17959193342 -2316.37108160893 -1127.97394098372 -354.478233703349 -75.1242017393757 "
     "-10.8753180355343 -1.06221498588947 -0.670191154593408E-01 -0.246781078275479E-02 -0.402962525080404E-04",
     "298.084530995537 559.779865474950 466.477572127796 227.204274477751 71.6478660875927 15.2897178747400 "
     "2.23691159816033 0.221624321934227 0.142363763154724E-01 0.535617408889821E-03 0.896632837373868E-05",
     "0.334801051324544E-02"),
    ("Longley", [row[1:] for row in rows(LONGLEY)], " ".join(row[0] for row in rows(LONGLEY)), [[0, 0]] + [[at, 1] for at in range(6)],
     "-3482258.63459582 15.0618722713733 -0.358191792925910E-01 -2.02022980381683 -1.03322686717359 "
     "-0.511041056535807E-01 1829.15146461355",
     "890420.383607373 84.9149257747669 0.334910077722432E-01 0.488399681651699 0.214274163161675 "
     "0.226073200069370 455.478499142212",
     "304.854073561965"),
    ("Wampler1", COUNTS, WAMPLER1_Y, polynomial(5),
     "1.00000000000000 1.00000000000000 1.00000000000000 1.00000000000000 1.00000000000000 1.00000000000000",
     "0 0 0 0 0 0",
     "0"),
    ("Wampler2", COUNTS, WAMPLER2_Y, polynomial(5),
     "1.00000000000000 0.100000000000000 0.100000000000000E-01 0.100000000000000E-02 0.100000000000000E-03 "
     "0.100000000000000E-04",
     "0 0 0 0 0 0",
     "0"),
    ("Wampler3", COUNTS, WAMPLER3_Y, polynomial(5),
     "1.00000000000000 1.00000000000000 1.00000000000000 1.00000000000000 1.00000000000000 1.00000000000000",
     "2152.32624678170 2363.55173469681 779.343524331583 101.475507550350 5.64566512170752 0.112324854679312",
     "2360.14502379268"),
    ("Wampler4", COUNTS, WAMPLER4_Y, polynomial(5),
     "1.00000000000000 1.00000000000000 1.00000000000000 1.00000000000000 1.00000000000000 1.00000000000000",
     "215232.624678170 236355.173469681 77934.3524331583 10147.5507550350 564.566512170752 11.2324854679312",
     "236014.502379268"),
    ("Wampler5", COUNTS, WAMPLER5_Y, polynomial(5),
     "1.00000000000000 1.00000000000000 1.00000000000000 1.00000000000000 1.00000000000000 1.00000000000000",
     "21523262.4678170 23635517.3469681 7793435.24331583 1014755.07550350 56456.6512170752 1123.24854679312",
     "23601450.2379268"),
]


def inverse(matrix):
    """Gauss-Jordan elimination in rational numbers."""
    size = len(matrix)
    work = [row + [Fraction(int(at == other)) for other in range(size)] for at, row in enumerate(matrix)]
    for at in range(size):
        pivot = next(row for row in range(at, size) if work[row][at])
        work[at], work[pivot] = work[pivot], work[at]
        work[at] = [value / work[at][at] for value in work[at]]
        for row in range(size):
            if row != at and work[row][at]:
                work[row] = [a - work[row][at] * b for a, b in zip(work[row], work[at])]
    return [row[size:] for row in work]


def solved(design, y):
    """Estimates and the squares of their standard deviations and of the residual standard deviation."""
    columns = list(zip(*design))
    cofactors = inverse([[sum(a * b for a, b in zip(one, other)) for other in columns] for one in columns])
    right = [sum(a * b for a, b in zip(column, y)) for column in columns]
    estimates = [sum(a * b for a, b in zip(row, right)) for row in cofactors]
    residuals = [value - sum(a * b for a, b in zip(row, estimates)) for row, value in zip(design, y)]
    variance = sum(value * value for value in residuals) / (len(y) - len(columns))
    return estimates, [variance * cofactors[at][at] for at in range(len(columns))], variance


def digits(value, root):
    """Fifteen significant digits of a rational number or of its square root."""
    with localcontext() as context:
        context.prec = 80
        exact = Decimal(value.numerator) / Decimal(value.denominator)
        exact = exact.sqrt() if root else exact
        context.prec = 15
        return +exact


def certified(name, text, exact, root=False):
    """The certified values, each equal to the solution in all its digits."""
    for word, value in zip(text.split(), exact, strict=True):
        if Decimal(word) != digits(value, root):
            sys.exit(f"{name}: certified {word}, solved {digits(value, root)}")
    return [float(word) for word in text.split()]


def case(name, x, y, terms, estimates, deviations, residual):
    x_exact, y_exact = [[Fraction(word) for word in row] for row in x], [Fraction(word) for word in y.split()]
    design = [[row[predictor] ** power for predictor, power in terms] for row in x_exact]
    exact = solved(design, y_exact)
    return {
        "example": f"NIST StRD {name}",
        "source": f"NIST StRD, {name}.dat",
        "x": [[float(word) for word in row] for row in x],
        "y": [float(word) for word in y.split()],
        "terms": terms,
        "estimates": certified(name, estimates, exact[0]),
        "deviations": certified(name, deviations, exact[1], root=True),
        "residual": certified(name, residual, [exact[2]], root=True)[0],
    }


def main():
    sets = ",\n".join(json.dumps(case(*of), separators=(",", ":")) for of in SETS)
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).with_suffix(".json")
    target.write_text(f"[\n{sets}\n]\n")


if __name__ == "__main__":
    main()
