"""Draws a stand-in for a person's photo: a helmeted head with initials."""

from __future__ import annotations

import io

from PIL import Image, ImageDraw, ImageFont

_SIZE_PX = 192


def portrait_png(name: str, helmet_colour: str) -> bytes:
    """A square PNG; the same name and colour always give the same picture."""
    image = Image.new("RGB", (_SIZE_PX, _SIZE_PX), "#e8e4dc")
    draw = ImageDraw.Draw(image)
    draw.rounded_rectangle((26, 138, 166, 230), radius=44, fill="#37474f")
    draw.ellipse((60, 52, 132, 148), fill="#d7a98c")
    draw.pieslice((46, 20, 146, 132), start=180, end=360, fill=helmet_colour)
    draw.rounded_rectangle((36, 70, 156, 84), radius=7, fill=helmet_colour)
    initials = "".join(part[0] for part in name.split())[:2].upper()
    font = ImageFont.load_default(size=34)
    draw.text((_SIZE_PX / 2, 168), initials, font=font, fill="#ffffff", anchor="mm")
    encoded = io.BytesIO()
    image.save(encoded, "PNG")
    return encoded.getvalue()
