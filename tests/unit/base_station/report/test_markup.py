from __future__ import annotations

from base_station.report.markup import Markup, UrgentRow, element, joined, table


def test_texts_and_attributes_are_escaped_and_markup_is_not():
    made = element("td", "<b>&", element("i", "'x'"), class_='"><script>')
    assert made == ('<td class="&quot;&gt;&lt;script&gt;">&lt;b&gt;&amp;<i>&#x27;x&#x27;</i></td>')


def test_characters_that_no_page_can_hold_are_replaced():
    assert joined("a\x00b\ud800") == "a\ufffdb\ufffd"


def test_numbers_are_short_and_missing_ones_left_out():
    assert element("rect", x=1.0, y=2.345, stroke_width=0.5, class_=None) == (
        '<rect x="1" y="2.3" stroke-width="0.5"></rect>'
    )


def test_an_urgent_row_stands_out_and_short_texts_stay_on_one_line():
    made = table(("a", "b"), [("short", "a text that is rather long"), UrgentRow(("x", "y"))])
    assert made.count('class="urgent"') == 1
    assert '<span class="one-line">short</span>' in made
    assert "<td>a text that is rather long</td>" in made


def test_markup_stays_markup_when_it_is_joined():
    assert isinstance(joined(Markup("<br>"), "&"), Markup)
    assert joined(Markup("<br>"), "&") == "<br>&amp;"
