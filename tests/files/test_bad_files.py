"""Bad input: each gets its own sentence, and nothing else ever comes out."""

import contextlib
import io
import pickle
import struct
import zlib
from pathlib import Path

import h5py
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.files import (
    LARGEST_FILE,
    MOST_DEMONSTRATIONS,
    MOST_SAMPLES,
    PARSERS,
    BadValueError,
    FileError,
    NoFileError,
    PickledError,
    TooLargeError,
    UnknownFormatError,
    UnreadableError,
    inspect,
    inspect_bytes,
    read,
    write,
)
from tests.files.makers import GOOD, csv_of, demonstrations, hdf5_of, line, mat_of, npy_of, npz_of, zip_of
from tests.files.malformed import MALFORMED, TRACES


class Bomb:
    """Leaves a trace when it is unpickled."""

    def __init__(self, trace: Path) -> None:
        self.trace = trace

    def __reduce__(self) -> tuple[object, ...]:
        return (Path.touch, (self.trace,))


def huge_npy() -> bytes:
    """An array that announces a million million rows and holds none."""
    out = io.BytesIO()
    np.lib.format.write_array_header_1_0(out, {"descr": "<f8", "fortran_order": False, "shape": (10**12, 3)})
    return out.getvalue()


def with_nan(values: np.ndarray) -> np.ndarray:
    copy = values.copy()
    copy[6, 1] = np.nan
    return copy


@pytest.mark.parametrize("suffix", PARSERS)
@pytest.mark.parametrize("content", [b"", b"\n \n"])
def test_an_empty_file_is_called_empty(suffix: str, content: bytes) -> None:
    with pytest.raises(UnreadableError, match="empty"):
        inspect_bytes(f"a{suffix}", content)


@pytest.mark.parametrize("suffix", PARSERS)
def test_noise_is_no_file_of_any_kind(suffix: str) -> None:
    noise = np.random.default_rng(3).bytes(4000)

    with pytest.raises(FileError, match=f"a{suffix}"):
        inspect_bytes(f"a{suffix}", noise)


@pytest.mark.parametrize("name", [name for name in GOOD if name != "a.csv"])
@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
def test_a_truncated_file_is_refused(name: str, part: float) -> None:
    content = GOOD[name]

    with pytest.raises(FileError):
        inspect_bytes(name, content[: int(part * len(content))])


@settings(max_examples=150, deadline=None)
@given(name=st.sampled_from(sorted(GOOD)), data=st.data())
def test_damage_gives_a_file_error_or_a_reading_and_nothing_else(name: str, data: st.DataObject) -> None:
    content = bytearray(GOOD[name])
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))

    reading = None
    with contextlib.suppress(FileError):
        reading = inspect_bytes(name, bytes(content))

    assert reading is None or all(np.isfinite(d.positions).all() for d in reading.demonstrations)


def test_text_in_a_number_column_is_found_by_line_and_column() -> None:
    with pytest.raises(BadValueError, match=r"line 3, column y: 'oops' is not a number") as caught:
        inspect_bytes("a.csv", b"t,x,y,z\n0,0,0,0\n0.1,1,oops,0\n")

    assert caught.value.where == "line 3, column y"


@pytest.mark.parametrize("word", ["nan", "inf", "1e999", ""])
def test_a_number_that_is_none_is_found_by_line_and_column(word: str) -> None:
    with pytest.raises(BadValueError, match="line 4, column z"):
        inspect_bytes("a.csv", f"x,y,z\n0,0,0\n\n1,1,{word}\n".encode())


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.mat", mat_of(line(), with_nan(line()))),
        ("a.npy", npy_of(np.stack([line(), with_nan(line())]))),
        ("a.npz", npz_of(positions=np.stack([line(), with_nan(line())]))),
    ],
)
def test_a_nan_is_found_by_demonstration_and_sample(name: str, content: bytes) -> None:
    with pytest.raises(BadValueError, match=r"demonstration 2, sample 7: the position .*NaN"):
        inspect_bytes(name, content)


def test_an_absurdly_large_number_is_found() -> None:
    with pytest.raises(BadValueError, match="sample 2: the position is larger than"):
        inspect_bytes("a.csv", b"x,y,z\n0,0,0\n1e300,0,0\n")


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.csv", csv_of(line()[:1], "x,y,z")),
        ("a.mat", mat_of(line(), line()[:1])),
        ("a.npy", npy_of(line()[:1])),
        ("a.h5", hdf5_of(np.ones((7, 1)))),
    ],
)
def test_one_sample_is_no_motion(name: str, content: bytes) -> None:
    with pytest.raises(BadValueError, match="one sample"):
        inspect_bytes(name, content)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.csv", b"t,x,y,z\n0,1,2,3\n0.1,1,2,3\n"),
        ("a.npy", npy_of(np.ones((2, 3)))),
        ("a.h5", hdf5_of(np.ones((7, 2)))),
    ],
)
def test_two_identical_samples_are_no_motion(name: str, content: bytes) -> None:
    with pytest.raises(BadValueError, match="all 2 samples are in the same place"):
        inspect_bytes(name, content)


def test_a_clock_that_runs_backwards_is_refused() -> None:
    with pytest.raises(BadValueError, match="sample 3: the time goes back"):
        inspect_bytes("a.csv", b"t,x,y,z\n0,0,0,0\n1,1,0,0\n0,0,0,0\n1,1,1,0\n")


def test_a_zero_quaternion_is_refused() -> None:
    with pytest.raises(BadValueError, match="sample 2: the orientation is all zeros"):
        inspect_bytes("a.csv", b"x,y,z,qw,qx,qy,qz\n0,0,0,1,0,0,0\n1,0,0,0,0,0,0\n")


@pytest.mark.parametrize(
    ("header", "words"),
    [
        (b"t,x,y", "no column z among t, x, y"),
        (b"t,x,y,z,x", "two columns x"),
        (b"x,y,z,qw,qx", "no qy and no qz"),
    ],
)
def test_a_header_that_is_not_enough_says_what_is_missing(header: bytes, words: str) -> None:
    with pytest.raises(BadValueError, match=words):
        inspect_bytes("a.csv", header + b"\n0,0,0,0,0\n")


def test_columns_without_names_are_not_guessed() -> None:
    with pytest.raises(BadValueError, match="6 columns and no names"):
        inspect_bytes("a.csv", b"1,2,3,4,5,6\n")


def test_a_short_line_is_found() -> None:
    with pytest.raises(BadValueError, match="line 3: there are 2 values, but 3"):
        inspect_bytes("a.csv", b"x,y,z\n0,0,0\n1,1\n")


@pytest.mark.parametrize("content", ["x,y,z\n1,2,é".encode("latin-1"), b"x,y,z\n1,2,\x00"])
def test_a_table_that_is_no_text_is_refused(content: bytes) -> None:
    with pytest.raises(BadValueError, match=r"line 2: it is not text"):
        inspect_bytes("a.csv", content)


@pytest.mark.parametrize("name", ["a.txt", "a", "a.mat.zip", ".csv"])
def test_a_wrong_suffix_lists_the_known_ones(name: str) -> None:
    with pytest.raises(UnknownFormatError, match=r"\.mat, \.csv, \.npy, \.npz, \.h5, \.hdf5") as caught:
        inspect_bytes(name, b"1,2,3")

    assert caught.value.known == tuple(PARSERS)


def test_a_missing_file_is_said_to_be_missing(tmp_path: Path) -> None:
    with pytest.raises(NoFileError, match="There is no file"):
        read(tmp_path / "gone.csv")


def test_a_folder_is_said_to_be_a_folder(tmp_path: Path) -> None:
    folder = tmp_path / "set.csv"
    folder.mkdir()

    with pytest.raises(NoFileError, match="is a folder"):
        read(folder)


def test_a_large_file_is_refused_before_it_is_read(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    with path.open("wb") as file:
        file.truncate(500 * 2**20)  # sparse: takes no room

    with pytest.raises(TooLargeError, match="524,288,000 bytes") as caught:
        inspect(path)

    assert caught.value.limit == LARGEST_FILE


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.npy", npy_of(np.zeros((MOST_SAMPLES + 1, 3), dtype=np.int8))),
        ("a.npz", npz_of(positions=np.zeros((1, MOST_SAMPLES + 1, 3)))),
        ("a.npz", npz_of(positions=np.zeros((MOST_SAMPLES + 1, 3)), lengths=np.array([MOST_SAMPLES + 1]))),
        ("a.mat", mat_of(np.zeros((MOST_SAMPLES + 1, 3)))),
        ("a.csv", b"x,y,z\n" + b"0,0,0\n" * (MOST_SAMPLES + 1)),
        ("a.npy", npy_of(np.zeros((MOST_DEMONSTRATIONS + 1, 2, 3)))),
        ("a.csv", b"demo,x,y,z\n" + b"".join(b"%d,0,0,0\n" % i for i in range(MOST_DEMONSTRATIONS + 1))),
    ],
)
def test_too_many_samples_or_demonstrations_are_refused(name: str, content: bytes) -> None:
    with pytest.raises(TooLargeError, match="at most 200"):
        inspect_bytes(name, content)


def test_an_hdf5_file_that_announces_too_much_is_refused_without_reading_it() -> None:
    out = io.BytesIO()
    with h5py.File(out, "w") as file:  # chunked and never written: takes no room
        file.create_dataset(
            "demo1/tf_info/pos_rot_data", (7, 10**11), "f4", chunks=(7, 1000), compression="gzip"
        )

    with pytest.raises(TooLargeError, match="100,000,000,000 samples"):
        inspect_bytes("a.h5", out.getvalue())


def test_an_hdf5_link_into_another_file_is_not_followed() -> None:
    out = io.BytesIO()
    with h5py.File(out, "w") as file:
        file["demo1"] = h5py.ExternalLink("other.h5", "/demo1")

    with pytest.raises(UnreadableError, match="no group"):
        inspect_bytes("a.h5", out.getvalue())


def test_numbers_that_an_hdf5_file_keeps_in_another_file_are_not_read(tmp_path: Path) -> None:
    secret = tmp_path / "secret.txt"
    secret.write_bytes(bytes(range(140)))
    out = io.BytesIO()
    with h5py.File(out, "w") as file:
        group = file.create_group("demo1/tf_info")
        group.create_dataset("pos_rot_data", (7, 20), "u1", external=[(str(secret), 0, 140)])

    with pytest.raises(UnreadableError, match="in another file"):
        inspect_bytes("a.h5", out.getvalue())


def test_a_deep_hdf5_link_into_another_file_is_not_followed(tmp_path: Path) -> None:
    other = tmp_path / "other.h5"
    other.write_bytes(GOOD["a.h5"])
    out = io.BytesIO()
    with h5py.File(out, "w") as file:
        file.create_group("demo1")["tf_info"] = h5py.ExternalLink(str(other), "/demo1/tf_info")

    with pytest.raises(UnreadableError, match="no group"):
        inspect_bytes("a.h5", out.getvalue())


def test_an_hdf5_bomb_is_refused_by_the_size_of_its_pieces() -> None:
    out = io.BytesIO()
    with h5py.File(out, "w") as file:
        file.create_dataset(
            "demo1/tf_info/pos_rot_data",
            (7, 20),
            "f8",
            chunks=(7, 2**21),
            maxshape=(7, None),
            compression="gzip",
        )

    with pytest.raises(TooLargeError, match="unpacks to"):
        inspect_bytes("a.h5", out.getvalue())


def test_a_zip_bomb_is_refused_by_what_it_announces(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.files.archives.LARGEST_UNPACKED", 8 * 2**20)  # quicker than at 256 MB
    bomb = zip_of({f"{i}.npy": bytes(2**20) for i in range(9)})
    assert len(bomb) < 2**16

    with pytest.raises(TooLargeError, match="unpacks to"):
        inspect_bytes("a.npz", bomb)


def test_a_mat_bomb_is_refused_while_it_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("app.files.mat_format.LARGEST_UNPACKED", 8 * 2**20)  # quicker than at 256 MB
    packer = zlib.compressobj()
    packed = b"".join(packer.compress(bytes(2**20)) for _ in range(9)) + packer.flush()
    header = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"

    with pytest.raises(TooLargeError, match="unpacks to more than"):
        inspect_bytes("a.mat", header + struct.pack("<II", 15, len(packed)) + packed)


@pytest.mark.parametrize("name", ["a.npy", "a.npz"])
def test_an_announced_shape_is_believed_only_as_far_as_there_are_bytes(name: str) -> None:
    content = huge_npy() if name == "a.npy" else zip_of({"positions.npy": huge_npy()})

    with pytest.raises(UnreadableError, match="ends before"):
        inspect_bytes(name, content)


def test_no_code_of_a_file_is_ever_run(tmp_path: Path) -> None:
    trace = tmp_path / "ran"
    objects = np.array([Bomb(trace)], dtype=object)
    pickled = npy_of(objects, allow_pickle=True)

    for name, content in {
        "a.npy": pickled,
        "b.npy": pickle.dumps(Bomb(trace)),
        "a.npz": zip_of({"positions.npy": pickled}),
    }.items():
        with pytest.raises(PickledError, match="Python objects"):
            inspect_bytes(name, content)

    assert not trace.exists()


@pytest.mark.parametrize("name", MALFORMED)
def test_a_malformed_file_gives_a_sentence_and_runs_nothing(name: str) -> None:
    with pytest.raises(FileError, match=rf"{name}.*\.$") as caught:
        inspect_bytes(f"../../{name}", MALFORMED[name])

    assert ".." not in str(caught.value).replace("'../../outside.npy'", "")
    assert TRACES == []


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.mat", mat_of(line(), name="roughData"), "no cell called smoothData"),
        ("a.mat", mat_of(line().T), r"demonstration 1: the cell holds float64 of shape \(3, 20\)"),
        ("a.mat", b"MATLAB 7.3 MAT-file".ljust(600), "7.3"),
        ("a.npy", npy_of(line()[:, :2]), r"shape \(20, 2\)"),
        ("a.npy", npy_of(np.array([["a", "b", "c"]] * 5)), "<U1"),
        ("a.npz", npz_of(a=line(), b=line()), "no array positions, only a, b"),
        ("a.npz", npz_of(positions=line(), times=np.arange(7)), r"times has shape \(7,\)"),
        ("a.npz", npz_of(positions=line(), lengths=np.array([5, 5])), "lengths does not divide"),
        ("a.h5", hdf5_of(np.ones((6, 20))), "not an array of 7 rows"),
        ("a.h5", hdf5_of(np.ones((7, 20)), np.ones((2, 19))), "not as many times"),
    ],
)
def test_another_layout_is_described(name: str, content: bytes, words: str) -> None:
    with pytest.raises(FileError, match=words):
        inspect_bytes(name, content)


@pytest.mark.parametrize("name", ["a.npy", "a.txt", "a"])
def test_only_formats_that_hold_everything_are_written(name: str, tmp_path: Path) -> None:
    with pytest.raises(UnknownFormatError, match=r"\.csv, \.npz, \.mat"):
        write(tmp_path / name, demonstrations())


def test_nothing_is_not_written(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="nothing to write"):
        write(tmp_path / "a.csv", [])


def test_a_folder_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileError, match="cannot be written"):
        write(tmp_path / "gone" / "a.csv", demonstrations())
