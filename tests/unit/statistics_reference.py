"""Prints the values that report_statistics_test.cpp and study_results_test.cpp expect, computed by SciPy and statsmodels.

Needs scipy 1.17.1 and statsmodels 0.15.0 in a scratch environment: python3 statistics_reference.py
"""
import numpy as np
import statsmodels.api as sm
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

welch = stats.ttest_ind(tied[0], [0.1, -1.2, 0.4, 0.9], equal_var=False)
print("welch", *(repr(float(v)) for v in (*welch.confidence_interval(), welch.pvalue)))

# Senn (2002), table 3.1: the treatment effect of a two-period crossover is half the difference of two samples.
senn = stats.ttest_ind([40, 50, 70, 20, 40, 30, -35], [-15, -90, -30, -30, -80, -130])
print("crossover of two columns", repr(float(senn.pvalue)))

people = range(12)
columns = np.array([[1 if i % 2 == 0 else -1, 1, 1 if i % 4 < 2 else -1] for i in people], float)
values = [(1 if i % 2 == 0 else -1) * 1.05 + .1 * (1 if i % 4 < 2 else -1) - .2 + .3 * np.sin(1 + 5 * i) for i in people]
fit = sm.OLS(values, columns).fit()
for i in range(3):
    print("ols", *(repr(float(v)) for v in (fit.params[i], *fit.conf_int()[i], fit.pvalues[i])))
