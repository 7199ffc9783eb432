"""Which words of file names are taken for cameras."""

import pytest

from courtside.drafting import advice, camera_words
from courtside.drafting import guess as session_guess
from fixtures.study.drafts import recording


def takes(*names, **lengths_s):
    """Return the cameras and takes of videos of 20 s, and whether users are told to check them.

    `lengths_s` are those of others, by the name of the file without its ending.
    """
    films = [
        recording(f"data/north/{name}.mp4", duration_s=lengths_s.get(name, 20.0))
        for name in sorted(names)
    ]
    guess = session_guess.guess(films)
    said = advice.to_check(guess, "n.yaml", "c.csv", "s.yaml")
    files = {
        take: {camera: r.path.removeprefix("data/north/")[:-4] for camera, r in own.items()}
        for take, own in guess.takes.items()
    }
    odd = [line for line in said if line.startswith("Odd: ")]
    return files, odd


def each(pattern, **words):
    """Return the names that a pattern gives with all combinations of words."""
    names = [pattern]
    for key, values in words.items():
        names = [name.replace(f"<{key}>", value) for name in names for value in values.split()]
    return names


SIDES = {"camera": "left right"}
EMPTY = ("left_empty", "right_empty")


def test_a_number_behind_the_word_of_a_known_camera_counts_takes():
    found, odd = takes(*each("smash_<camera>_<n>", **SIDES, n="01 02 03"), *EMPTY)
    assert found == {
        f"smash_{n}": {"left": f"smash_left_{n}", "right": f"smash_right_{n}"}
        for n in ("01", "02", "03")
    }
    assert odd == []
    found, odd = takes(*each("<camera> <n>", **SIDES, n="1 2"), *EMPTY, "walk1")
    assert found == {n: {"left": f"left {n}", "right": f"right {n}"} for n in ("1", "2")}
    assert odd == []


@pytest.mark.parametrize("pattern", ["smash_<camera>_<n>", "<camera> <n>", "smash <camera>-<n>"])
def test_equal_numbers_behind_the_words_of_cameras_count_takes(pattern):
    found, odd = takes(*each(pattern, **SIDES, n="1 2 3"))
    assert found == {
        n: {camera: each(pattern, camera=camera, n=n)[0] for camera in ("left", "right")}
        for n in ("1", "2", "3")
    }
    (line,) = odd
    assert "left, right were taken for cameras, 1, 2, 3 for takes" in line


def test_numbers_at_the_words_of_cameras_may_belong_to_them_if_lengths_allow_it():
    names = each("<take>_<camera><n>", take="serve lob", **SIDES, n="1 2")
    found, odd = takes(*names)
    assert set(found) == {"serve", "lob"}
    assert set(found["lob"]) == {"left1", "left2", "right1", "right2"}
    assert "can be read in several ways" in odd[0]
    found, odd = takes(*names, lob_left2=40.0, lob_right2=41.0)
    assert found["lob_2"] == {"left": "lob_left2", "right": "lob_right2"}
    assert "can be read in several ways" in odd[0]


def test_sides_of_a_person_are_no_cameras_beside_numbered_ones_and_folders_of_cameras():
    found, odd = takes(*each("<camera>_<leg>_leg", camera="cam1 cam2", leg="left right"))
    assert found == {
        leg: {c: f"{c}_{leg}_leg" for c in ("cam1", "cam2")} for leg in ("left", "right")
    }
    assert "cam1, cam2 were taken for cameras, left, right for takes" in odd[0]
    found, odd = takes(*each("<camera>/<leg>_leg", camera="front side", leg="left right"))
    assert found == {
        leg: {c: f"{c}/{leg}_leg" for c in ("front", "side")} for leg in ("left", "right")
    }
    assert "front, side were taken for cameras, left, right for takes" in odd[0]
    found, odd = takes(*each("<leg>/<camera>", camera="front side", leg="left right"))
    assert set(found) == {"left", "right"}
    assert "can be read in several ways" in odd[0]


def test_numbers_alone_may_be_cameras_or_takes():
    found, odd = takes("1_1", "1_2", "2_1", "2_2")
    assert found == {"1": {"1": "1_1", "2": "1_2"}, "2": {"1": "2_1", "2": "2_2"}}
    assert "1, 2 were taken for cameras, 1, 2 for takes" in odd[0]


def test_unknown_words_may_be_cameras_or_takes():
    assert "can be" in takes(*each("<camera>_<take>", camera="tall low", take="serve lob"))[1][0]
    assert takes("serve_tall", "serve_low")[1] == []


@pytest.mark.parametrize("pattern", ["<camera>/<take>", "<camera>/<take>_<camera>"])
def test_of_words_that_may_be_cameras_or_takes_lengths_choose(pattern):
    lengths_s = {"serve": 20.0, "lob": 31.0, "drive": 45.0}
    of = {take: each(pattern, camera="net tribune", take=take) for take in lengths_s}
    lengths = {name: lengths_s[take] for take, names in of.items() for name in names}
    found, odd = takes(*lengths, **lengths)
    assert {take: [*films.values()] for take, films in found.items()} == of
    assert "net, tribune were taken for cameras" in odd[0]


def test_the_words_of_two_cameras_in_a_name_are_told():
    for pattern in ("<camera>/<leg>_leg", "<leg>_1_<camera>"):
        _, odd = takes(*each(pattern, **SIDES, leg="left right"), *EMPTY)
        assert any("can be read in several ways" in line for line in odd)


def test_names_with_take_before_camera_need_no_look():
    assert takes(*each("smash_<n>_<camera>", **SIDES, n="1 2"))[1] == []
    assert takes(*each("<camera>_<n>", camera="cam1 cam2", n="1 2"))[1] == []
    assert takes(*each("P1_<camera>_squat_<n>", **SIDES, n="1 2"))[1] == []


def test_walks_that_may_be_takes_are_told():
    """No take is found, or a walk has the word of a camera."""
    found, odd = takes("left_empty", "serve_left", "volley_right")
    assert found == {}
    assert "volley_right.mp4 was taken for a walk" in odd[0]
    _, odd = takes(*each("walking_<camera>_<n>", **SIDES, n="01 02"), *EMPTY)
    assert sum("was taken for a walk" in line for line in odd) == 4
    assert takes(*EMPTY, "walk")[1] == []


def test_a_camera_without_a_recording_of_the_empty_hall_is_told_by_takes_of_others():
    one_take = {"serve": {"left": "serve_left", "right": "serve_right"}}
    assert takes("left_empty", "serve_left", "serve_right") == (one_take, [])
    two_takes = each("<take>_<camera>", take="a b", camera="cam1 cam2 cam3")
    assert [len(take) for take in takes("cam2_empty", *two_takes, "walk")[0].values()] == [3, 3]
    assert len(takes("left_empty", "left", "right", "walk")[0]["take1"]) == 2


def test_words_of_the_hall_name_no_camera_where_players_walk():
    names = each("walk<n>_<camera>", n="1 2", **SIDES)
    found, _ = takes(*names, "empty_hall_left", "empty_hall_right", "hall")
    assert list(map(list, found.values())) == 2 * [["left", "right"]]


@pytest.mark.parametrize(
    "empty",
    [
        "empty_court_<camera>",
        "<camera>_empty_hall",
        "<camera>/empty court",
        "<camera>/leere Halle",
        "<camera>/Leeraufnahme",
        "empty_hall_<camera>_20260503",
    ],
)
@pytest.mark.parametrize("cameras", ["left right", "cam1 cam2", "tall low"])
def test_words_of_the_hall_name_no_camera(empty, cameras):
    names = each("<take>_<camera>", take="serve lob", camera=cameras)
    found, odd = takes(*names, *each(empty, camera=cameras), "walk")
    assert {tuple(take) for take in found.values()} == {tuple(sorted(cameras.split()))}
    assert (list(found), odd) == (["lob", "serve"], [])


def test_a_camera_that_films_no_take_of_others_walks():
    assert takes(*EMPTY, "left", "right", "gopro1")[0] == {
        "take1": {"left": "left", "right": "right"}
    }
    filmed = takes(*EMPTY, "a_left", "a_right", "round_gopro1")[0]
    assert filmed == {"a": {"left": "a_left", "right": "a_right"}}


@pytest.mark.parametrize(
    ("cameras", "empty"),
    [
        ("front side ceiling", ()),
        ("cam1 cam2 topcam", ()),
        ("left right baseline", ()),
        ("a b c", ("a_empty", "b_empty")),
        ("north_east north_west top", ("north_east_empty",)),
    ],
)
@pytest.mark.parametrize("pattern", ["<take>_<camera>", "<camera>_<take>", "<camera>/<take>"])
def test_a_camera_of_another_kind_of_word_films_the_takes_of_others(cameras, empty, pattern):
    every = cameras.split()
    found, odd = takes(*each(pattern, camera=cameras, take="serve lob"), *empty, "gopro_hall")
    assert found == {
        take: {one: each(pattern, camera=one, take=take)[0] for one in every}
        for take in ("serve", "lob")
    }
    assert odd == []


def test_takes_that_share_no_camera_are_told():
    found, odd = takes("trial1/A_00", "trial1/C_05", "trial2/A_01", "trial2/C_06")
    assert [len(take) for take in found.values()] == [2, 2]
    assert not set(found["trial1"]) & set(found["trial2"])
    assert any("can be read in several ways" in line for line in odd)


def test_a_walk_with_the_words_of_a_take_is_told():
    for take in ("serve", "スマッシュ"):
        _, odd = takes(*each("<take>_<camera>", **SIDES, take=f"{take} lob"), f"{take}_on_the_roof")
        assert f"{take}_on_the_roof.mp4 was taken for a walk; if a fixed camera" in odd[0]


def test_several_walks_without_a_camera_are_told():
    found, odd = takes(*each("<camera>/walk1", camera="north south"))
    assert found == {}
    assert sum("was taken for a walk" in line for line in odd) == 2
    assert takes("walk1")[1] == []


@pytest.mark.parametrize("date", ["20260503", "2026-05-03"])
def test_a_date_behind_the_word_of_a_camera_is_no_number_of_it(date):
    names = each(f"<take>_<camera>_{date}", camera="net east west", take="a b")
    found, odd = takes(*names, "net_empty", "east_empty")
    assert [list(films) for films in found.values()] == 2 * [["east", "net", "west"]]
    assert odd == []


@pytest.mark.parametrize("pattern", ["<camera>_<n>", "<camera>/trial<n>", "trial<n>_<camera>"])
@pytest.mark.parametrize("cameras", ["GoPro1 GoPro2 iPhone1", "GoPro-9 iPhone-13 iPhone-14"])
def test_cameras_are_told_by_gopro_and_iphone_as_people_write_them(pattern, cameras):
    found, odd = takes(*each(pattern, camera=cameras, n="1 2"))
    assert [name[-1] for name in found] == ["1", "2"]
    assert all(len(take) == 3 for take in found.values())
    assert odd == []


def test_a_camera_of_more_words_goes_first():
    cameras = {"left": ("left",), "far_left": ("far", "left")}
    assert camera_words.told(("far", "left", "serve"), cameras) == ("far_left", ("serve",))
    assert camera_words.told(("serve", "left"), cameras) == ("left", ("serve",))
    assert camera_words.told(("serve",), cameras) == (None, ("serve",))


def test_a_recording_of_another_length_is_no_camera_of_a_take():
    films = *EMPTY, "game1_left", "game1_right", "walk"
    sides = {"left": "game1_left", "right": "game1_right"}
    assert takes(*films, "game1_slowmo", game1_slowmo=60.0)[0] == {"game1": sides}


def test_a_camera_that_films_the_empty_hall_alone_stays():
    names = "empty_left", "empty_right", "empty_back", "rally_left", "rally_right", "walk"
    films = [recording(f"data/north/{name}.mp4") for name in sorted(names)]
    assert set(session_guess.guess(films).cameras) == {"left", "right", "back"}
    assert takes(*names)[0] == {"rally": {"left": "rally_left", "right": "rally_right"}}


def test_a_walk_that_is_called_so_needs_no_look_in_the_folder_of_its_take():
    films = [f"{take}/{camera}" for take in ("match", "warmup") for camera in ("left", "right")]
    assert takes(*films, "match/walk")[1] == []


@pytest.mark.parametrize(
    ("left", "right", "empty", "stroke"),
    [
        ("gauche", "droite", "vide", "service"),
        ("izquierda", "derecha", "vacía", "saque"),
        ("sinistra", "destra", "vuoto", "battuta"),
        ("esquerda", "direita", "vazio", "saque"),
    ],
)
def test_romance_words_name_cameras_and_the_empty_court(left, right, empty, stroke):
    names = [f"{side} {stroke} {n}" for n in (1, 2) for side in (left, right)]
    alone, odd = takes(*names)
    assert {take: sorted(films) for take, films in alone.items()} == {
        f"{stroke}{n}": sorted([left, right]) for n in (1, 2)
    }
    assert takes(*names, f"{left} {empty}", f"{right} {empty}") == (alone, odd) == (alone, [])
