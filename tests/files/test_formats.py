"""What each format means, and that writing and reading are opposites."""

from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.files import FORMATTERS, inspect, inspect_bytes, read, write
from gc_core import Demonstration, same_content
from tests.files.makers import (
    DATA,
    GOOD,
    csv_of,
    demonstrations,
    hdf5_of,
    line,
    mat_of,
    needs_data,
    npy_of,
    npz_of,
    poses_of,
    quaternions,
)


def only(name: str, content: bytes) -> Demonstration:
    (demonstration,) = inspect_bytes(name, content).demonstrations
    return demonstration


@pytest.mark.parametrize("suffix", FORMATTERS)
def test_what_was_written_is_read_back(suffix: str, tmp_path: Path) -> None:
    written = demonstrations()
    path = tmp_path / f"skill{suffix}"

    write(path, written)
    found = read(path, units="m")

    assert len(found) == len(written)
    for a, b in zip(found, written, strict=True):
        for field in fields(Demonstration):
            if field.name != "times":
                assert same_content(getattr(a, field.name), getattr(b, field.name)), field.name
        np.testing.assert_allclose(a.times, b.times - b.times[0], atol=1e-12)


@settings(max_examples=25, deadline=None)
@given(
    suffix=st.sampled_from(sorted(FORMATTERS)),
    lengths=st.lists(st.integers(2, 12), min_size=1, max_size=4),
    names=st.lists(
        st.text(st.characters(codec="utf-8", categories=["L", "P", "Zs"]), max_size=9), min_size=4
    ),
)
def test_any_names_and_lengths_survive_a_round_trip(
    suffix: str, lengths: list[int], names: list[str], tmp_path_factory: pytest.TempPathFactory
) -> None:
    path = tmp_path_factory.mktemp("files") / f"skill{suffix}"
    written = [
        Demonstration(np.arange(n) * 0.1, line(n), name=name) for n, name in zip(lengths, names, strict=False)
    ]

    write(path, written)

    assert [len(d.times) for d in read(path, units="m")] == [len(d.times) for d in written]


@pytest.mark.parametrize("separator", [",", ";", "\t", " "])
def test_csv_columns_are_found_by_name_whatever_separates_them(separator: str) -> None:
    rows = np.column_stack([line()[:, ::-1], np.arange(20) / 10.0])
    content = csv_of(rows, "Z,y,X,time").replace(b",", separator.encode())

    found = only("a.csv", content)

    np.testing.assert_array_equal(found.positions, line())
    np.testing.assert_allclose(found.times, np.arange(20) / 10.0)


def test_a_decimal_comma_is_understood_where_the_semicolon_separates() -> None:
    content = b"t;x;y;z\n0,0;0,1;0,2;0,3\n0,1;0,2;0,2;0,3\n"

    np.testing.assert_array_equal(only("a.csv", content).positions, [[0.1, 0.2, 0.3], [0.2, 0.2, 0.3]])


@pytest.mark.parametrize("width", [3, 4])
def test_csv_without_a_header_is_x_y_z_with_or_without_t_before(width: int) -> None:
    rows = np.column_stack([np.arange(20) / 10.0, line()])[:, 4 - width :]
    content = csv_of(rows).split(b"\n", 1)[1]

    np.testing.assert_array_equal(only("a.csv", content).positions, line())


def test_csv_header_behind_a_comment_sign_is_a_header() -> None:
    content = b"# made by hand\n# t x y z\n0 1 2 3\n0.1 2 2 3\n# the end\n"

    np.testing.assert_array_equal(only("a.csv", content).positions, [[1, 2, 3], [2, 2, 3]])


def test_csv_demo_column_divides_demonstrations_in_order_of_appearance() -> None:
    content = b"demo,x,y,z\nB,0,0,0\nB,1,0,0\nA,0,0,1\nB,2,0,0\nA,1,1,1\n"

    found = inspect_bytes("a.csv", content).demonstrations

    assert [(d.name, len(d.times)) for d in found] == [("B", 3), ("A", 2)]


def test_orientations_are_w_x_y_z_in_every_format() -> None:
    pose = np.column_stack([line(), quaternions()])
    header = "x,y,z,qw,qx,qy,qz"
    files = {
        "a.csv": csv_of(pose, header),
        "a.npy": npy_of(pose),
        "a.npz": npz_of(positions=pose),
        "a.h5": hdf5_of(poses_of(line(), quaternions())),
    }

    for name, content in files.items():
        found = only(name, content)
        assert found.orientations is not None, name
        np.testing.assert_allclose(found.orientations, quaternions(), atol=1e-12, err_msg=name)


def test_mat_cells_are_demonstrations_in_metres() -> None:
    reading = inspect_bytes("a.mat", mat_of(line(scale=30.0), line(7)))

    assert reading.unit == "m"
    assert reading.samples == (20, 7)
    np.testing.assert_array_equal(reading.demonstrations[0].positions, line(scale=30.0))


def test_hdf5_clock_keeps_its_nanoseconds() -> None:
    nanoseconds = np.arange(20) * 123_457.0
    clock = np.stack([np.full(20, 1_629_729_350.0), 9.9e8 + nanoseconds])

    found = only("a.h5", hdf5_of(poses_of(line(), quaternions()), clock))

    np.testing.assert_allclose(found.times, nanoseconds * 1e-9, rtol=1e-6)


def test_a_sample_with_the_time_of_the_one_before_is_left_out_and_counted() -> None:
    reading = inspect_bytes("a.csv", b"t,x,y,z\n5,0,0,0\n5,1,0,0\n6,2,0,0\n")

    assert reading.repeated == 1
    np.testing.assert_array_equal(reading.demonstrations[0].times, [0.0, 1.0])
    assert "1 repeated" in reading.summary


@pytest.mark.parametrize("name", GOOD)
def test_upper_case_suffixes_are_known(name: str) -> None:
    assert inspect_bytes(name.upper(), GOOD[name]).samples == inspect_bytes(name, GOOD[name]).samples


@needs_data
@pytest.mark.parametrize(
    ("pattern", "count", "longest"),
    [("tlgc/alpha.mat", 5, 1.0), ("robotasks/pos_ori/*.npy", 9, 1.0), ("canal_lab_demos/*.h5", 1, 1.2)],
)
def test_public_recordings_come_out_in_metres(pattern: str, count: int, longest: float) -> None:
    paths = sorted(DATA.glob(pattern))
    assert paths
    for path in paths:
        found = read(path)

        assert len(found) == count, path.name
        extents = [np.linalg.norm(np.ptp(d.positions, axis=0)) for d in found]
        assert 0.1 < min(extents) <= max(extents) < longest, path.name


@needs_data
def test_public_recordings_with_a_clock_last_as_long_as_they_did() -> None:
    for path in sorted(DATA.glob("canal_lab_demos/*.h5")):
        reading = inspect(path)

        assert reading.times_in_file
        assert 5.0 < reading.durations[0] < 15.0
