"""Style of a report, on a screen and on paper: black on white, with line styles.

Pictures have their styles as attributes, as the library for PDF does not apply those of the page to
them.
"""

from __future__ import annotations

from typing import Final

STYLE: Final = """
@page { size: A4; margin: 16mm 14mm;
  @bottom-right { content: counter(page) " / " counter(pages); font-size: 9pt; } }
body { font: 10.5pt/1.35 "Liberation Sans", Arial, Helvetica, sans-serif;
  color: #000; background: #fff; margin: 0; }
main { max-width: 190mm; margin: 0 auto; padding: 6mm 3mm; }
h1 { font-size: 18pt; margin: 0 0 4mm; overflow-wrap: anywhere; }
h2 { font-size: 14pt; margin: 8mm 0 2mm; border-bottom: 2px solid #000; break-after: avoid; }
h3 { font-size: 11pt; margin: 4mm 0 1mm; break-after: avoid; overflow-wrap: anywhere; }
p { margin: 0 0 2mm; }
.note { color: #444; font-size: 9pt; break-after: avoid; }
.warning { border-left: 4px solid #000; padding-left: 3mm; font-weight: bold; }
ul.warning { padding-left: 8mm; font-weight: normal; }
dl { display: grid; grid-template-columns: 45mm 1fr; margin: 0 0 3mm; font-size: 11.5pt; }
dt { color: #444; } dd { margin: 0; font-weight: bold; overflow-wrap: anywhere; }
table { border-collapse: collapse; width: 100%; font-size: 9pt; margin-bottom: 4mm; }
table.short { width: auto; }
thead { display: table-header-group; }
th { text-align: left; border-bottom: 1.5px solid #000; padding: 1mm 1.5mm;
  vertical-align: bottom; }
td { border-bottom: 0.5px solid #bbb; padding: 0.8mm 1.5mm; vertical-align: top;
  overflow-wrap: anywhere; }
tr { break-inside: avoid; }
tr.urgent td { font-weight: bold; border-bottom: 1px solid #000; }
tr.urgent td:first-child { border-left: 4px solid #000; }
.one-line { white-space: nowrap; }
figure { margin: 0 0 4mm; break-inside: avoid; }
figure > svg { max-width: 100%; height: auto; border: 0.5px solid #bbb; }
figcaption { font-size: 9pt; font-weight: bold; overflow-wrap: anywhere; }
article { break-inside: avoid; }
.small-pictures figure { display: inline-block; vertical-align: top; max-width: 88mm;
  margin-right: 3mm; }
.photographs figure { display: inline-block; vertical-align: top; width: 88mm;
  margin-right: 3mm; }
.photographs img { max-width: 100%; max-height: 120mm; border: 0.5px solid #bbb; }
.photographs .note { font-weight: normal; }
@media print { main { max-width: none; padding: 0; } }
"""

Look = dict[str, str | float]  # attributes of a part of a picture

_FONT: Look = {"font_family": "Liberation Sans, Arial, Helvetica, sans-serif", "fill": "#000"}
SMALL: Look = {**_FONT, "font_size": 9.0}
RIGHT: Look = {**SMALL, "text_anchor": "end"}
MIDDLE: Look = {**SMALL, "text_anchor": "middle"}
NUMBER: Look = {**_FONT, "font_size": 12.0, "font_weight": "bold"}
ON_LINE: Look = {**MIDDLE, "font_weight": "bold"}
PAPER: Look = {"fill": "#fff"}
WALL: Look = {"fill": "none", "stroke": "#999", "stroke_width": 1.2}
TRAIL: Look = {
    "fill": "none",
    "stroke_width": 1.4,
    "stroke_linejoin": "round",
    "stroke_linecap": "round",
}
GAP: Look = {"fill": "none", "stroke_width": 1.4, "stroke_dasharray": "5 4"}
END: Look = {"fill": "#fff", "stroke_width": 1.6}
SCALE: Look = {"fill": "none", "stroke": "#000", "stroke_width": 1.2}
STRIP: Look = {"fill": "none", "stroke": "#bbb", "stroke_width": 0.8}
VALUE: Look = {"fill": "none", "stroke": "#000", "stroke_width": 1.2}
LIMIT: Look = {"fill": "none", "stroke": "#000", "stroke_width": 1.0, "stroke_dasharray": "1.5 2.5"}
RAISED: Look = {"fill": "none", "stroke": "#000", "stroke_width": 1.0}
