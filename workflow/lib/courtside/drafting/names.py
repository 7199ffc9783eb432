"""Words of file names in any script, and names that a configuration accepts.

Words that people use for cameras and takes are translated from Japanese, Chinese, Korean and
Russian; other letters are spelled by their names in Unicode. Chinese characters have no spelling of
their own: `guess` numbers what they name.
"""

import re
import unicodedata
from collections.abc import Collection, Iterable, Iterator

from courtside.study.configuration import configuration

LONGEST = 55  # of the 64 letters of a name; the others are for `walk_` and the number of `distinct`
DATE = re.compile(r"20\d\d([01]\d[0-3]\d)?")  # or a year; no number of a camera or take
WORD = re.compile(r"[A-Za-z]+[0-9]*|[0-9]+|[^\W\d_]+")
SIGNS = re.compile("[^a-z0-9]+")  # between the words of a name
LETTERS = {"ß": "ss", "æ": "ae", "œ": "oe", "ø": "o", "đ": "d", "ł": "l", "þ": "th"}
MEANINGS = {  # longer ones are looked for first
    "cam": "カメラ 카메라 相机 摄像机 攝影機 机位 камера",
    "left": "左側 左侧 左 ひだり 왼쪽 левая левый лево слева",
    "right": "右側 右侧 右 みぎ 오른쪽 правая правый право справа",
    "centre": "中央 中心 真ん中 센터 중앙 центр",
    "front": "正面 前方 前面 前 まえ 앞 정면 спереди",
    "back": "後方 後ろ 背面 后方 后面 後 后 うしろ 뒤 후면 сзади",
    "side": "側面 侧面 横 よこ 옆 측면 сбоку",
    "top": "真上 俯瞰 上方 сверху",
    "take": "テイク 撮影 拍摄 테이크 дубль",
    "trial": "試技 試行 测试 시도 попытка",
    "empty": "無人 空場 空场 背景 静止 빈 пусто фон",
    "walk": "歩行 巡回 步行 보행 обход",
    "calib": "キャリブレーション 校正 較正 标定 보정 калибровка",
    "video": "動画 映像 ビデオ 视频 영상 видео",
}
MEANING = {word: english for english, words in MEANINGS.items() for word in words.split()}
KNOWN = re.compile("|".join(sorted(map(re.escape, MEANING), key=len, reverse=True)))
SYLLABLES = ("HIRAGANA", "KATAKANA", "HANGUL")  # whose Unicode names end in how they sound
SILENT = {"SIGN", "MARK"}  # ends of such names of signs that only change others
ALPHABETS = {
    "абвгдеёжзийклмнопрстуфхцчшщъыьэюя": "a b v g d e yo zh z i y k l m n o p r s t u f kh ts ch "
    "sh shch _ y _ e yu ya",
    "αβγδεζηθικλμνξοπρσςτυφχψω": "a v g d e z i th i k l m n x o p r s s t y f ch ps o",
}
SPELLED = {
    letter: said.strip("_")
    for letters, spelled in ALPHABETS.items()
    for letter, said in zip(letters, spelled.split(), strict=True)
}


def words_of(parts: Iterable[str]) -> tuple[str, ...]:
    """Split the names of folders and of a file without its suffix into words.

    Lower case, without accents, known words in English; a number belongs to the word before it,
    but for a date: `Cam 01-takeTwo` gives `cam01`, `take`, `two`, and `左カメラ2` gives `left`,
    `cam2`.
    """
    found: list[str] = []
    for part in parts:
        own: list[str] = []
        for word in WORD.findall(_plain(part)):
            if word.isdigit() and own and not (own[-1][-1].isdigit() or DATE.fullmatch(word)):
                own[-1] += word
            else:
                own.append(word)
        found += own
    return tuple(word.lower() for word in found)


def name(text: str, otherwise: str) -> str:
    """Make a name that a configuration accepts: `a-z0-9_-`, begun with a letter or digit.

    Hyphens and underscores stay, other signs become underscores. `otherwise` is the name of a text
    without a letter or digit, of one with Chinese characters that are not known, and of one that no
    name may be, such as `con`. Long texts are cut.
    """
    plain = _plain(text)
    if any(_script(letter) == "CJK" for letter in plain):
        return otherwise
    spelled = "".join(_spelled(letter) for letter in plain)
    found = SIGNS.sub(lambda run: "_" if run[0].strip("-_") else run[0], spelled.lower())
    found = found.strip("-_")[:LONGEST].rstrip("-_")
    return found if configuration.NAME.fullmatch(found) else otherwise


def spelling(name: str, texts: Iterable[str]) -> str:
    """Return the name of a camera or take as all texts spell it: `cam_0` where words are `cam0`.

    Only hyphens and underscores may differ, `color640_x480` is `color_640x480`; a name that texts
    spell in two ways stays.
    """
    words = re.sub("(?<![0-9])_|_(?![a-z])", "[-_]", re.escape(name))
    words = re.sub("(?<=[0-9])_(?=[a-z])", "[-_]?", words)
    words = re.sub("(?<=[a-z])(?=[0-9])", "[-_]?", words)
    pattern = re.compile(f"(?<![a-z0-9]){words}(?![a-z0-9])")
    found = {(pattern.search(text.lower()) or [name])[0] for text in texts}
    return found.pop() if len(found) == 1 else name


def distinct(wanted: str, taken: Collection[str]) -> str:
    """Return a name, with the first number after it that makes it differ from those taken."""
    found, number = wanted, 1
    while found in taken:
        number += 1
        found = f"{wanted}_{number}"
    return found


def alike(one: str, other: str) -> bool:
    """Return whether words differ only by zeros before their numbers, as `cam1` and `cam01`."""
    return _unpadded(one) == _unpadded(other)


def _unpadded(word: str) -> str:
    return re.sub(r"(?<![0-9])0+(?=[0-9])", "", word)


def _plain(text: str) -> str:
    """Return a text in usual letters, known words translated, camel case split into words."""
    text = unicodedata.normalize("NFKC", text)  # digits and letters of full width
    text = "".join(LETTERS.get(letter.lower(), letter) for letter in text)
    text = "".join(_without_accents(text))
    text = re.sub("GoPro|iPhone|iPad", lambda found: found[0].title(), text)  # one word each
    text = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", text)
    return KNOWN.sub(lambda found: f" {MEANING[found[0].lower()]} ", _lower_cyrillic(text))


def _without_accents(text: str) -> Iterator[str]:
    """Yield Latin letters without accents, and other letters, which marks would change, whole."""
    for letter in text:
        first, *marks = list(unicodedata.normalize("NFD", letter))
        latin = first.isascii() and all(map(unicodedata.combining, marks))
        if latin or not unicodedata.combining(letter):
            yield first if latin else letter


def _lower_cyrillic(text: str) -> str:
    return "".join(c.lower() if _script(c) == "CYRILLIC" else c for c in text)


def _script(letter: str) -> str:
    return "" if letter.isascii() else re.split("[ -]", unicodedata.name(letter, ""))[0]


def _spelled(letter: str) -> str:
    """Return a letter in Latin ones; a syllable as its Unicode name ends."""
    small = letter.lower()
    bare = unicodedata.normalize("NFD", small)[0]
    if small in SPELLED or bare in SPELLED:
        return SPELLED[small if small in SPELLED else bare]
    if _script(letter) not in SYLLABLES:
        return letter
    last = unicodedata.name(letter).split(" ")[-1]
    return "" if last in SILENT else last
