"""What figures share: style, bars, oblique views, stick figures, looks of sources."""
