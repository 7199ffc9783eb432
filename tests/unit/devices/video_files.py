"""Small videos whose pictures tell their own frame number."""

from fractions import Fraction

import av
import numpy as np

BITS = 8
H264 = {"g": "12", "bf": "2", "threads": "1"}


def draw(number, size=(160, 120)):
    """Draw a picture with its number as eight dark or bright blocks along the top (lowest bit first)."""
    width, height = size
    y, x = np.mgrid[:height, :width]
    image = np.stack(
        [60 + x * 60 // width, 120 - y * 60 // height, 90 + 30 * (x // 8 % 2)], axis=-1
    )
    edges = np.linspace(0, width, BITS + 1).astype(int)
    for bit in range(BITS):
        image[: height // 3, edges[bit] : edges[bit + 1]] = 230 if number >> bit & 1 else 20
    return image.astype(np.uint8)


def number_in(image):
    """Read the number that `draw` drew."""
    height, width = image.shape[:2]
    centres = ((np.arange(BITS) + 0.5) * width / BITS).astype(int)
    values = [image[height // 8 : height // 5, x - 3 : x + 4].mean() for x in centres]
    return sum(1 << bit for bit, value in enumerate(values) if value > 125)


def numbers(frames):
    return [number_in(image) for _, image in frames]


def write(
    path, codec="libx264", *, n=60, size=(160, 120), rate=30, ticks=None, images=None, options=None,
    container=None, pix_fmt="yuv420p", turn=None, sound_s=None, form=None,
):  # fmt: skip
    """Write a video with PyAV; `ticks` are its time stamps in milliseconds, `turn` its display rotation."""
    options = H264 if options is None and codec == "libx264" else options or {}
    with av.open(path, "w", format=form, options=container or {}) as out:
        stream = out.add_stream(codec, rate=rate, options=options)
        stream.width, stream.height, stream.pix_fmt = *size, pix_fmt
        if ticks is not None:
            stream.codec_context.time_base = Fraction(1, 1000)
        if turn:
            stream.set_display_rotation(turn[0], hflip=turn[1])
        sound = sound_s and out.add_stream("pcm_s16le", rate=8000, layout="mono")
        for k, image in enumerate(images or (draw(k, size) for k in range(n))):
            frame = av.VideoFrame.from_ndarray(image, format="bgr24")
            frame.pts, frame.time_base = (
                (k, Fraction(1, rate)) if ticks is None else (ticks[k], Fraction(1, 1000))
            )
            out.mux(stream.encode(frame))
        out.mux(stream.encode())
        if sound:
            samples = av.AudioFrame.from_ndarray(
                np.zeros((1, int(8000 * sound_s)), np.int16), "s16", "mono"
            )
            samples.sample_rate = 8000
            out.mux(sound.encode(samples))
            out.mux(sound.encode())
    return path


def packets(path):
    """Return (pts, position, size) of every packet, in the order of decoding."""
    with av.open(path) as container:
        return [(p.pts, p.pos, p.size) for p in container.demux(video=0) if p.size]


def good_frames(path, cut):
    """Count the frames shown before the first that does not lie wholly within `cut` bytes."""
    listed = packets(path)
    lost = [pts for pts, position, size in listed if position + size > cut]
    return sum(pts < min(lost) for pts, _, _ in listed)
