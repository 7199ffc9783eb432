"""Numbers of networks: virtual takes with their intervals, jitter with more decimals."""

from courtside.evaluation.numbers import networks


def test_networks_are_shown_with_their_intervals(source, value):
    found = networks.virtual(source)
    name = "`blazepose-full`; virtual, `repeats`"
    assert {number.row for number in found} == {name}  # no recorded take
    assert value(found, name, "pck").printed == "94.4" and value(found, name, "pck").n == 10
    assert value(found, name, "pck_from").printed == "93.1"
    assert value(found, name, "jitter_to").printed == "0.60"
    assert {number.origin for number in found} == {"study"}
