"""An enrolment out of a picture of its QR code, and one sentence for each picture without one."""

from __future__ import annotations

import io
import math
from pathlib import Path

import numpy as np
import pytest
import segno
from PIL import Image, ImageFilter
from typer.testing import CliRunner

from base_station.security.pki.folder import PkiFolder
from base_station.security.pki.qr import qr_code, save_png
from edge.cli import app
from shared import enrolment_picture
from shared.enrolment import Enrolment, read_enrolment
from shared.errors import ConfigError

CANVAS_PX = (1800, 1800)
GREY = (120, 110, 100)


@pytest.fixture(scope="module")
def pki(tmp_path_factory: pytest.TempPathFactory) -> PkiFolder:
    folder = PkiFolder(tmp_path_factory.mktemp("station"))
    folder.create("Freiwillige Feuerwehr Übungsdorf", ["192.0.2.7"], ["tls/192.0.2.7:7447"])
    return folder


@pytest.fixture(scope="module")
def enrolment(pki: PkiFolder) -> Enrolment:
    return pki.enroll("FF-01")


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "photo"  # what it is does not go by its name


def drawn(code: segno.QRCode) -> Image.Image:
    picture = io.BytesIO()
    code.save(picture, kind="png", scale=6)
    return Image.open(picture).convert("RGB")


def photo(code: Image.Image, turned_deg: float, tilted_deg: float) -> Image.Image:
    """As a camera with a lens of usual width sees the screen: turned, tilted, blurred, noisy."""
    turned, tilted = math.radians(turned_deg), math.radians(tilted_deg)
    corners = []
    for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
        right = x * math.cos(turned) - y * math.sin(turned)
        down = x * math.sin(turned) + y * math.cos(turned)
        px = 2200.0 / (4.0 + down * math.sin(tilted))
        corners.append((900 + right * px, 900 + down * math.cos(tilted) * px))
    width, height = code.size
    seen = code.transform(
        CANVAS_PX,
        Image.Transform.PERSPECTIVE,
        perspective(corners, [(0, 0), (width, 0), (width, height), (0, height)]),
        Image.Resampling.BICUBIC,
        fillcolor=GREY,
    ).filter(ImageFilter.GaussianBlur(1.0))
    noise = np.random.default_rng(1).normal(0.0, 8.0, (*reversed(CANVAS_PX), 1))
    return Image.fromarray((np.asarray(seen) + noise).clip(0, 255).astype(np.uint8))


def perspective(here: list[tuple[float, float]], there: list[tuple[int, int]]) -> tuple[float, ...]:
    """Coefficients of the projective map, from four pairs of points."""
    rows, values = [], []
    for (x, y), (u, v) in zip(here, there, strict=True):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y], [0, 0, 0, x, y, 1, -v * x, -v * y]]
        values += [u, v]
    return tuple(np.linalg.solve(np.array(rows), np.array(values)))


def refusal(path: Path) -> str:
    with pytest.raises(ConfigError) as refused:
        read_enrolment(path)
    assert str(refused.value).startswith(f"{path}: ")
    return str(refused.value)


def test_the_code_as_the_station_saves_it(enrolment: Enrolment, path: Path) -> None:
    save_png(qr_code(enrolment), path, "renew")
    assert read_enrolment(path) == enrolment


@pytest.mark.parametrize(("turned_deg", "tilted_deg"), [(0, 0), (17, 25), (90, 35), (200, 45)])
def test_a_photograph_at_an_angle(
    enrolment: Enrolment, path: Path, turned_deg: float, tilted_deg: float
) -> None:
    photo(drawn(qr_code(enrolment)), turned_deg, tilted_deg).save(path, "JPEG", quality=80)
    assert read_enrolment(path) == enrolment


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP"])
def test_each_kind_of_picture(enrolment: Enrolment, path: Path, kind: str) -> None:
    drawn(qr_code(enrolment)).save(path, kind)
    assert read_enrolment(path) == enrolment


def test_another_code_beside_it_is_not_taken_for_it(enrolment: Enrolment, path: Path) -> None:
    beside([drawn(segno.make_qr("https://station.test")), drawn(qr_code(enrolment))], path)
    assert read_enrolment(path) == enrolment


def test_picture_with_two_enrolments_is_refused(
    pki: PkiFolder, enrolment: Enrolment, path: Path
) -> None:
    beside([drawn(qr_code(one)) for one in (enrolment, pki.enroll("FF-02"))], path)
    assert "there are 2 enrolments in this picture" in refusal(path)


def beside(codes: list[Image.Image], path: Path) -> None:
    both = Image.new("RGB", (sum(one.width for one in codes), max(one.height for one in codes)))
    both.paste((255, 255, 255), (0, 0, *both.size))
    x = 0
    for one in codes:
        both.paste(one, (x, 0))
        x += one.width
    both.save(path, "PNG")


def test_a_code_of_something_else(path: Path) -> None:
    drawn(segno.make_qr("https://station.test")).save(path, "PNG")
    assert "is no enrolment; take the one that the station shows" in refusal(path)


def test_a_code_that_is_cut_off(enrolment: Enrolment, path: Path) -> None:
    code = drawn(qr_code(enrolment))
    code.crop((0, 0, code.width, code.height * 2 // 3)).save(path, "PNG")
    assert "no QR code can be read" in refusal(path)


def test_a_code_that_is_out_of_focus(enrolment: Enrolment, path: Path) -> None:
    drawn(qr_code(enrolment)).filter(ImageFilter.GaussianBlur(12.0)).save(path, "JPEG")
    assert "no QR code can be read" in refusal(path)


def test_a_damaged_enrolment_in_a_sharp_code(enrolment: Enrolment, path: Path) -> None:
    drawn(segno.make_qr(enrolment.to_compact()[:-40], error="l")).save(path, "PNG")
    assert "the scanned enrolment is cut short; scan the code again" in refusal(path)


def test_a_picture_that_was_copied_in_part(enrolment: Enrolment, path: Path) -> None:
    whole = io.BytesIO()
    drawn(qr_code(enrolment)).save(whole, "PNG")
    path.write_bytes(whole.getvalue()[:300])
    assert "the picture is damaged" in refusal(path)


def test_a_kind_of_picture_that_is_not_read(path: Path) -> None:
    path.write_bytes(b"\x00\x00\x00\x18ftypheic" + bytes(100))
    assert "neither JPEG, PNG nor WebP; save it as one of these" in refusal(path)


def test_a_picture_that_would_not_fit_the_memory(path: Path) -> None:
    Image.new("1", (10_000, 10_000)).save(path, "PNG")
    assert "more than 60 million pixels" in refusal(path)


def test_a_file_without_end(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shared.enrolment._MOST_PICTURE_BYTES", 100_000)
    path.write_bytes(b"\xff\xd8\xff" + bytes(200_000))
    assert "larger than 0 MB" in refusal(path)


def test_without_the_library_it_is_named(
    enrolment: Enrolment, path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def missing(name: str) -> object:
        raise ImportError(f"No module named {name!r}")

    drawn(qr_code(enrolment)).save(path, "PNG")
    monkeypatch.setattr(enrolment_picture, "import_module", missing)
    assert "deploy/requirements-pictures.lock" in refusal(path)


def test_a_picture_is_made_a_file(
    enrolment: Enrolment, path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    drawn(qr_code(enrolment)).save(path, "PNG")
    done = CliRunner().invoke(app, ["enrol", str(path)])
    assert done.exit_code == 0, done.output
    assert f"delete {path}" in done.output
    made = tmp_path / "FF-01.enrolment.toml"
    assert read_enrolment(made) == enrolment
    assert made.stat().st_mode & 0o777 == 0o600
