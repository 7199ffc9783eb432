"""The exponent found is the one that the times were made with."""

import numpy as np
import pytest

from courtside.figures.calibration import growth

HEAD = "s\th:m:s\tmax_rss\tmax_vms"


@pytest.fixture
def paths(tmp_path):
    files = {}
    for count in (10, 20, 80):
        for offset in (0, 1):
            files[f"map_images/global-n{count}-o{offset}"] = [2 * count**1.5]
        files[f"map_images/incremental-n{count}-o0"] = [0.5 * count**2]
    files["adjust_network/global-n10-o0"] = [4.0]
    files["match_images/all"] = [60.0, 80.0]
    for name, seconds in files.items():
        path = tmp_path / f"{name}.tsv"
        path.parent.mkdir(exist_ok=True)
        rows = [
            f"{value}\t0:00:01\t{'-' if name.startswith('adjust') else 250.5}\t900"
            for value in seconds
        ]
        path.write_text("\n".join([HEAD, *rows]) + "\n")
    return sorted(tmp_path.glob("*/*.tsv"))


def test_the_table_holds_the_files_values(paths):
    rows = growth.table(paths)
    assert len(rows) == 11
    once = rows[rows["step"] == "match_images"].squeeze()
    assert (once.mapper, once.seconds, once.max_rss_mb) == (growth.ONCE, 70.0, 250.5)
    assert np.isnan(once.n_bridging)
    assert np.isnan(rows.loc[rows["step"] == "adjust_network", "max_rss_mb"]).all()


def test_exponents_are_those_of_the_power_laws(paths):
    laws = growth.exponents(growth.table(paths)).set_index(["step", "mapper"])
    found = laws.loc[("map_images", "global")]
    np.testing.assert_allclose([found.exponent, found.factor_s], [1.5, 2.0])
    np.testing.assert_allclose(laws.loc[("map_images", "incremental")].exponent, 2.0)
    assert found.n == 6
    assert np.isnan(laws.loc[("adjust_network", "global")].exponent)


def test_the_legend_states_the_exponent(paths):
    drawing = growth.draw(growth.table(paths), "made up")
    labels = drawing.axes[0].get_legend_handles_labels()[1]
    assert "map_images, global: N$^{1.50}$ (n = 6)" in labels
    assert "adjust_network, global" in labels
    assert "match_images, once per session" in labels
    assert drawing.axes[0].get_xscale() == drawing.axes[0].get_yscale() == "log"


def test_marks_of_several_choices_of_images_stand_side_by_side(paths):
    axis = growth.draw(growth.table(paths)).axes[0]
    handles = dict(zip(*reversed(axis.get_legend_handles_labels()), strict=True))
    (line,) = (line for label, line in handles.items() if label.startswith("map_images, global"))
    x = np.sort(line.get_xdata()).reshape(-1, 2)
    counts = np.array([10, 20, 80])
    assert (x[:, 0] < counts).all() and (counts < x[:, 1]).all()
    np.testing.assert_allclose(x, np.repeat(counts[:, None], 2, axis=1), rtol=0.05)
