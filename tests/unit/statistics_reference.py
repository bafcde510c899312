"""Prints the values that report_statistics_test.cpp expects, computed by SciPy and statsmodels.

Needs scipy 1.17.1 and statsmodels 0.15.0 in a scratch environment: python3 statistics_reference.py
"""
from scipy import stats
from statsmodels.stats.multitest import multipletests

holm = [.011, .3, .0004, .02, .02, .9, .013]
print("holm", [repr(float(p)) for p in multipletests(holm, method="holm")[1]])

exact = [[1.83 - .878, .5 - .647, 1.62 - .598, 2.48 - 2.05, 1.68 - 1.06, 1.88 - 1.29, 1.55 - 1.06, 3.06 - 3.14,
          1.3 - 1.29],
         [.5 * i * (-1) ** (i % 3) for i in range(1, 26)],
         [1, 2, 3, 4, 5, 6]]
for d in exact:
    print("wilcoxon exact", float(stats.wilcoxon(d, method="exact").pvalue))
tied = [[1.2, 2.4, 1.3, 1.3, 0, 1, 1.8, .8, 4.6, 1.4],
        [(i % 7) - 2 for i in range(60)],
        [.25 * i * (-1) ** (i % 3) for i in range(1, 27)]]  # 26: no ties, but too many for the exact distribution
for d in tied:
    print("wilcoxon normal", float(stats.wilcoxon(d, zero_method="wilcox", correction=True, method="asymptotic").pvalue))

for d in (tied[0], exact[1]):
    t = stats.ttest_rel(d, [0] * len(d))
    print("t", repr(float(sum(d) / len(d))), *(repr(float(v)) for v in (*t.confidence_interval(), t.pvalue)))
