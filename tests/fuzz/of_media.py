"""Formats of pictures, videos, networks, COLMAP's files, and folders of recordings surveyed."""

import contextlib
import shutil

import cv2
import numpy as np

from courtside.calibration.boards import chessboard
from courtside.drafting import draft as session_advice
from courtside.drafting import guess as session_guess
from courtside.drafting import survey
from courtside.pages.clicking import page
from courtside.pose import open_network
from courtside.pose.conversion import tflite_onnx
from courtside.pose.networks import session as onnx_session
from courtside.sfm import database, model
from courtside.study.configuration import yaml_files
from courtside.study.execution import files
from courtside.video import reader, walk_frames
from fixtures.cameras import sfm_made
from fixtures.recordings import video_files
from fuzz.format import Format, require
from fuzz.of_cameras import clicked, own_toml, real
from fuzz.of_devices import bags, bvhs

BOARD = (7, 5)


def picture(number=5, size=(160, 120)):
    """Return a small picture."""
    return video_files.draw(number, size)


def pngs(folder):
    """Write PNG files: colour, grey, 16 bits, with transparency."""
    grey = cv2.cvtColor(picture(), cv2.COLOR_BGR2GRAY)
    cv2.imwrite(str(folder / "colour.png"), picture())
    cv2.imwrite(str(folder / "grey.png"), grey)
    cv2.imwrite(str(folder / "deep.png"), grey.astype(np.uint16) * 257)
    cv2.imwrite(str(folder / "clear.png"), cv2.cvtColor(picture(), cv2.COLOR_BGR2BGRA))


def jpegs(folder):
    """Write JPEG files, plain and progressive; a smaller copy of a real one."""
    cv2.imwrite(str(folder / "plain.jpg"), picture())
    cv2.imwrite(str(folder / "steps.jpg"), picture(), [cv2.IMWRITE_JPEG_PROGRESSIVE, 1])
    for path in real("people/*.jpg")[:1]:
        small = cv2.resize(cv2.imread(str(path)), (160, 120))
        cv2.imwrite(str(folder / "real.jpg"), small)


def read_photo(path):
    """Read a photo as a frame of a walk and as a picture to click in."""
    with contextlib.suppress(ValueError):  # the page takes dark ones too
        page.frame("c", path)
    found = walk_frames.read_photo(path)
    require(found.dtype == np.uint8 and found.ndim == 3, "a picture of another kind")
    return found


def boards(folder):
    """Write pictures of a chessboard."""
    made = folder / "board"
    made.mkdir()
    y, x = np.mgrid[:240, :320]
    squares = ((x // 30 + y // 30) % 2 * 200 + 20).astype(np.uint8)
    squares[:30], squares[:, :40], squares[210:], squares[:, 280:] = 255, 255, 255, 255
    cv2.imwrite(str(made / "1.png"), squares)
    cv2.imwrite(str(made / "2.jpg"), np.roll(squares, 7, axis=1))


def read_board(path):
    """Look for a chessboard."""
    return chessboard.find(path, BOARD)


def mp4s(folder):
    """Write MP4 files: H.264, with sound, turned, at irregular times."""
    video_files.write(str(folder / "plain.mp4"), n=8)
    video_files.write(str(folder / "turned.mp4"), n=4, turn=(90, False))
    video_files.write(
        str(folder / "sound.mp4"), n=6, sound_s=0.2, container={"movflags": "faststart"}
    )
    video_files.write(str(folder / "uneven.mp4"), n=5, ticks=[0, 33, 70, 133, 140])


def other_videos(folder):
    """Write videos in other containers and codecs."""
    video_files.write(str(folder / "a.avi"), "mjpeg", n=4, pix_fmt="yuvj420p")
    video_files.write(str(folder / "b.mkv"), n=6)
    video_files.write(str(folder / "c.webm"), "libvpx", n=4)
    video_files.write(str(folder / "d.ts"), "mpeg2video", n=6)
    video_files.write(str(folder / "e.mov"), "mpeg4", n=6)


def read_video(path):
    """Read a video's description, times, pictures."""
    info, times_s = reader.probe(path), reader.frame_times(path)
    require((np.diff(times_s) > 0).all() and min(info.size) > 0, "times or size")
    for (time_s, image), expected_s in zip(reader.frames(path), times_s, strict=True):
        require(image.shape[1::-1] == info.size and time_s == expected_s, "a picture")
    return info


def networks(folder):
    """Write small networks: convolution, sums, sparse and short constants."""
    from fixtures.recordings.tflite_files import Network, sparse_rows

    rng = np.random.default_rng(0)
    kernel = rng.normal(size=(4, 3, 3, 3)).astype(np.float32)
    window = {"strideH": 1, "strideW": 1, "dilationHFactor": 1, "dilationWFactor": 1}
    for name in ("plain", "half", "sparse"):
        made = Network()
        image = made.image(1, 8, 8, 3)
        stored = kernel if name != "half" else kernel.astype(np.float16)
        if name == "sparse":
            dense = np.where(rng.random(kernel.shape) < 0.5, kernel, 0)
            values, layout = sparse_rows(dense)
            weights = made.tensor(dense.shape, "float32", values, layout)
        else:
            weights = made.constant(stored)
        if name == "half":
            weights = made.add("DEQUANTIZE", [weights], kernel.shape)
        bias = made.constant(np.zeros(4, np.float32))
        inputs = [image, weights, bias]
        conv = made.add("CONV_2D", inputs, (1, 8, 8, 4), "Conv2DOptions", **window)
        made.add("ADD", [conv, conv], (1, 8, 8, 4), "AddOptions")
        made.write(folder / f"{name}.tflite")


def convert(path):
    """Convert a network."""
    out = path.with_name("out.onnx")
    tflite_onnx.convert(path, out)
    require(out.is_file(), "no network")


def bases(folder):
    """Write a COLMAP database."""
    sfm_made.synthetic(folder / "matches.db", n_points=20, n_images=3)


def read_base(path):
    """Read a database as mapping does, in a copy."""
    with database.working_copy(path) as copy:
        found = database.image_ids(copy)
    require(len(set(found.values())) == len(found), "numbers of images")
    return found


def models(folder):
    """Write a COLMAP model."""
    found = sfm_made.synthetic(folder / "m.db", n_points=20, n_images=3)
    (folder / "m.db").unlink()
    (folder / "model").mkdir()
    found.write_binary(str(folder / "model"))


def recordings(folder):
    """Write a folder of recordings as people have them."""
    made = folder / "My Gym"
    (made / "board left").mkdir(parents=True)
    for name in ("Serve left", "Serve right", "left empty"):
        video_files.write(str(made / f"{name}.mp4"), n=3)
    for number in range(2):
        cv2.imwrite(str(made / "board left" / f"{number}.png"), picture(number))
    for make in (clicked, own_toml, bags, bvhs):
        make(made)
    for path in made.glob("*.bvh"):
        path.rename(made / "Serve.bvh")
    shutil.copy(made / "points.csv", made / "notes.csv")


def draft(path):
    """Survey a folder and draft its session, as `workflow/draft_session.py` does."""
    found = survey.survey(path, root=path.parent)
    guess = session_guess.guess(found)
    text = session_advice.text(guess, title=path.name, folder=path.name, court="badminton")
    out = path.with_name("gym.yaml")
    session_advice.write(out, text)
    points = session_advice.court_points(guess, path.name)
    session_advice.to_check(guess, out, points, "gym.yaml")
    return yaml_files.read(out)


GIVEN = {"size": [32, 24], "channels": "bgr", "padding": 1.25}
JOINTS = ("nose", "left_hip", "right_hip")


def own_networks(folder):
    """Write small ONNX networks."""
    from fixtures.recordings import onnx_files

    onnx_files.simcc(folder / "simcc.onnx", GIVEN["size"])
    onnx_files.heat_maps(folder / "maps.onnx", GIVEN["size"], 4)


def run_network(path):
    """Check an ONNX file and run it, as if its checksum were right."""
    onnx_session.check_file(path, files.sha256(path))
    decoder = "simcc" if path.stem.endswith("simcc") else "heatmaps"
    network = open_network.landmark_network(path, JOINTS, decoder=decoder, input=GIVEN)
    open_network.try_out(network)
    return network


FORMATS = [
    Format("png", 900, pngs, read_photo),
    Format("jpeg", 900, jpegs, read_photo),
    Format("chessboard", 200, boards, read_board),
    Format("mp4", 1000, mp4s, read_video),
    Format("other-video", 500, other_videos, read_video),
    Format("tflite", 700, networks, convert),
    Format("onnx", 400, own_networks, run_network),
    Format("colmap-database", 200, bases, read_base),
    Format("colmap-model", 200, models, model.read),
    Format("survey", 200, recordings, draft, refuses=False),  # it says what it cannot read
]
