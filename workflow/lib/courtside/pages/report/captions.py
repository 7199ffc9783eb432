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

    `source` is reStructuredText that may name `snakemake.wildcards` (session, take, network ...)
    and `snakemake.params` of the rule that drew the figure. `ValueError` if it names something that
    is not given, or is not reStructuredText.
    """
    snakemake = SimpleNamespace(wildcards=dict(wildcards or {}), params=dict(params or {}))
    try:
        text = ENVIRONMENT.from_string(source).render(snakemake=snakemake)
        parts = core.publish_parts(text, writer="html5", settings_overrides=SETTINGS)
    except (jinja2.TemplateError, core.utils.SystemMessage) as error:
        raise ValueError(f"caption: {' '.join(str(error).split())}: {source[:60]!r}") from None
    return Markup(parts["body"].strip())
