"""Draws of four chains and what ArviZ says of them: R̂ and effective sizes of Vehtari et al. (2021).

Writes diagnostics_draws.csv and diagnostics.csv beside this file. Needs arviz and numpy."""
import csv
import os

import arviz
import numpy as np

rng = np.random.default_rng(7)
CHAINS, DRAWS = 4, 120


def autoregressive(rho):
    chain = np.zeros((CHAINS, DRAWS))
    for i in range(1, DRAWS):
        chain[:, i] = rho * chain[:, i - 1] + rng.normal(size=CHAINS)
    return chain


columns = {
    "independent": rng.normal(size=(CHAINS, DRAWS)),
    "slow": autoregressive(0.9),
    "alternating": autoregressive(-0.6),
    "heavy_tails": rng.standard_cauchy(size=(CHAINS, DRAWS)),
    "one_apart": rng.normal(size=(CHAINS, DRAWS)) + np.array([0, 0, 0, 1.5])[:, None],
    "one_wide": rng.normal(size=(CHAINS, DRAWS)) * np.array([1, 1, 1, 4])[:, None],
    "ties": np.round(rng.normal(size=(CHAINS, DRAWS))),
}
here = os.path.dirname(os.path.abspath(__file__))
columns = {name: np.round(draws, 6) for name, draws in columns.items()}
with open(os.path.join(here, "diagnostics_draws.csv"), "w", newline="") as file:
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(["chain", *columns])
    for chain in range(CHAINS):
        for draw in range(DRAWS):
            writer.writerow([chain, *(repr(float(column[chain, draw])) for column in columns.values())])
with open(os.path.join(here, "diagnostics.csv"), "w", newline="") as file:
    writer = csv.writer(file, lineterminator="\n")
    file.write(f"# ArviZ {arviz.__version__}\n")
    writer.writerow(["name", "rhat", "ess_bulk", "ess_tail"])
    for name, draws in columns.items():
        data = arviz.convert_to_dataset({"x": draws})
        values = [
            arviz.rhat(data, method="rank"),
            arviz.ess(data, method="bulk"),
            arviz.ess(data, method="tail"),
        ]
        writer.writerow([name, *(repr(float(value["x"].values)) for value in values)])
