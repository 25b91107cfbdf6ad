"""Ten lines from a table to a figure: python fit_table.py [DATA.csv]"""

import sys

import pbrdf

data = pbrdf.read(sys.argv[1] if len(sys.argv) > 1 else "steel.csv")
result = pbrdf.fit(data, model="cauchy", fix={"ks": 1.0})
for name, estimate in result.parameters.items():
    print(f"{name:8} {estimate}    95 %: {estimate.interval95}")
print("\n".join(result.undetermined))
result.plot("dolp").figure.savefig("fit.png")
