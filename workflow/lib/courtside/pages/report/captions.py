"""Captions of figures: reStructuredText with Jinja, as Snakemake's own report takes them, made into HTML."""

from types import SimpleNamespace

import jinja2
from docutils import core
from markupsafe import Markup

SETTINGS = {
    "raw_enabled": False,  # a caption is text: it brings no HTML of its own
    "file_insertion_enabled": False,
    "doctitle_xform": False,
    "initial_header_level": 5,
    "report_level": 5,
    "halt_level": 3,
    "warning_stream": False,
    "output_encoding": "unicode",
}
ENVIRONMENT = jinja2.Environment(undefined=jinja2.StrictUndefined, autoescape=False)  # not HTML yet


def render(source, wildcards=None, params=None):
    """Return a caption as HTML.

    Parameters
    ----------
    source : str
        reStructuredText in which `snakemake.wildcards` and `snakemake.params` stand for the two below.
    wildcards : dict of str to str, optional
        Of the figure: session, take, network ...
    params : dict, optional
        Of the rule that drew it; `params.step.n_frames` is looked up in dictionaries.

    Returns
    -------
    html : str
        Paragraphs; everything that is no markup of the text is escaped.

    Raises
    ------
    ValueError
        If the caption asks for what is not given, or is no reStructuredText.
    """
    snakemake = SimpleNamespace(wildcards=dict(wildcards or {}), params=dict(params or {}))
    try:
        text = ENVIRONMENT.from_string(source).render(snakemake=snakemake)
        parts = core.publish_parts(text, writer="html5", settings_overrides=SETTINGS)
    except (jinja2.TemplateError, core.utils.SystemMessage) as error:
        raise ValueError(f"caption: {' '.join(str(error).split())}: {source[:60]!r}") from None
    return Markup(parts["body"].strip())
