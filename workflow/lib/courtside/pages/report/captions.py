"""Captions of figures as HTML, from reStructuredText with Jinja as in Snakemake's own report."""

from types import SimpleNamespace

import jinja2
from docutils import core
from markupsafe import Markup

SETTINGS = {
    "raw_enabled": False,  # a caption must not bring its own HTML
    "file_insertion_enabled": False,
    "doctitle_xform": False,
    "initial_header_level": 5,
    "report_level": 5,
    "halt_level": 3,
    "warning_stream": False,
    "output_encoding": "unicode",
}
ENVIRONMENT = jinja2.Environment(undefined=jinja2.StrictUndefined, autoescape=False)  # not HTML yet


def render(
    source: str, wildcards: dict[str, str] | None = None, params: dict | None = None
) -> Markup:
    """Return a caption as HTML paragraphs in which all text is escaped.

    Parameters
    ----------
    source
        reStructuredText that may name `snakemake.wildcards` and `snakemake.params`.
    wildcards
        Of the figure: session, take, network ...
    params
        Of the rule that drew it; `params.step.n_frames` is looked up in dictionaries.

    Raises
    ------
    ValueError
        If the caption names something that is not given, or is not reStructuredText.
    """
    snakemake = SimpleNamespace(wildcards=dict(wildcards or {}), params=dict(params or {}))
    try:
        text = ENVIRONMENT.from_string(source).render(snakemake=snakemake)
        parts = core.publish_parts(text, writer="html5", settings_overrides=SETTINGS)
    except (jinja2.TemplateError, core.utils.SystemMessage) as error:
        raise ValueError(f"caption: {' '.join(str(error).split())}: {source[:60]!r}") from None
    return Markup(parts["body"].strip())
