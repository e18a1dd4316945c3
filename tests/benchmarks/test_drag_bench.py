"""The whole work of one drag update, and how soon a tab has the answer.

Goal: a median and a 95th percentile under 15 ms for servo, learning at 200 stations from five
demonstrations, reproduction, drawing and messages. One drag sends an event each 50 ms; the hand moves at
0.2 m/s.
"""

from __future__ import annotations

import queue
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pytest
import viser
from pytest_benchmark.fixture import BenchmarkFixture

from app import files, skills, viewers
from app.actions import Drag
from app.arm import Jaco
from app.desk import Desk
from app.document import Document, FloatArray, Place, Shown
from app.pauses import avoid_pauses
from app.resources import static_folder
from app.viewers import Viewer
from gc_core import Demonstration
from tests.app.makers import place_of
from tests.panels.desk import Notes
from tests.support.fake_client import FakeClient

ROOT = Path(__file__).resolve().parents[2]
EVENT = 0.05
STEP = 0.01
"""Between two events [m]."""
EVENTS = 60
"""Of one drag: three seconds."""
GROUP = "one drag update"
NODES = ("/hand", "/landmarks/goal")
LINES = ("/demonstrations/0", "/reproductions/0")
SAMPLES = (500, 1500)


def reaching(n_samples: int) -> Document:
    """*Reaching* with so many samples in each demonstration."""
    document = skills.load_skill(static_folder() / "skills", "reaching")
    shown = tuple(Shown(resampled(one.demonstration, n_samples)) for one in document.demonstrations)
    return replace(document, demonstrations=shown)


def with_frame(document: Document) -> Document:
    """Two landmarks more: a way point, and an object that was turned, which acts through seven points."""
    way = document.demonstrations[0].demonstration.positions
    third, two_thirds = way[len(way) // 3], way[2 * len(way) // 3]
    more = (
        Place("way point", third, third, "via"),
        Place("box", two_thirds, two_thirds, "object", np.array([0.0, 0.0, 0.3])),
    )
    return replace(document, landmarks=(*document.landmarks, *more))


def resampled(demonstration: Demonstration, n_samples: int) -> Demonstration:
    times = np.linspace(0.0, demonstration.times[-1], n_samples)
    columns = [np.interp(times, demonstration.times, column) for column in demonstration.positions.T]
    return Demonstration(times, np.column_stack(columns), name=demonstration.name)


def way_of(node: str, at: FloatArray, count: int) -> FloatArray:
    """(count, 3) pointers: the hand along an arc, a landmark around a circle that comes back [m]."""
    angle = np.linspace(0.0, 2.0 * np.pi, count + 1)[1:]
    radius = STEP * count / (2.0 * np.pi)
    circle = radius * np.stack([1.0 - np.cos(angle), 0.0 * angle, np.sin(angle)], axis=1)
    return at + (circle if node == "/hand" else 0.5 * circle)


@dataclass
class Puller:
    """A desk, drawn in a connected tab, and a pull that goes on and on."""

    desk: Desk
    viewer: Viewer
    node: str
    now: float = 100.0
    left: int = 0
    worked: list[float] = field(default_factory=list[float])
    """Processor time of the session's thread for each update [s]: others on the machine disturb it less."""

    def one_event(self) -> tuple[tuple[Drag], dict[str, object]]:
        """The next event of the pull; a pull of 60 events is let go, undone, and begun again."""
        if self.left == 0:
            self._begin()
        self.left -= 1
        self.now += EVENT
        return (self._event("update", self.way[EVENTS - 1 - self.left]),), {}

    def update(self, drag: Drag) -> None:
        """What the session does with it."""
        began = time.thread_time()
        self.desk.drag(drag)
        self.viewer.draw(self.desk.state())
        self.worked.append(time.thread_time() - began)

    def _begin(self) -> None:
        self.now += 10.0
        self.desk.let_go(self.now)
        self.desk.amend(lambda amending: amending.discard())
        while self.desk.store.undo_name is not None:
            self.desk.undo(self.now)
        self.desk.tick(self.now + 2.0, 0.04)
        self.now += 10.0
        state = self.desk.state()
        self.viewer.draw(state)
        self.at = place_of(self.node, state.model, state.hand.position)
        self.way = way_of(self.node, self.at, EVENTS)
        self.desk.drag(self._event("start", self.at))
        self.left = EVENTS

    def _event(self, phase: str, pointer: FloatArray) -> Drag:
        return Drag(self.node, phase, self.at, pointer, self.now)


class Corrector(Puller):
    """The same, of the hand of a replay."""

    def _begin(self) -> None:
        desk = self.desk
        desk.let_go(self.now)
        desk.amend(lambda amending: amending.discard())
        self.now += 10.0
        desk.start_replay(self.now)
        while (replay := desk.state().replay) is not None and not len(replay.done):
            self.now += EVENT
            desk.tick(self.now, EVENT)
        state = desk.state()
        self.viewer.draw(state)
        self.at = state.hand.position
        self.way = way_of(self.node, self.at, EVENTS)
        desk.drag(self._event("start", self.at))
        self.left = EVENTS


@pytest.fixture(scope="module")
def handle() -> Iterator[viser.ClientHandle]:
    """One tab, connected."""
    server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
    connected: queue.Queue[viser.ClientHandle] = queue.Queue()
    server.on_client_connect(connected.put)
    with FakeClient(f"ws://127.0.0.1:{server.get_port()}"):
        yield connected.get(timeout=10.0)
    server.stop()


@pytest.fixture(scope="module")
def jaco() -> Iterator[Jaco]:
    arm = Jaco()
    yield arm
    arm.close()


@pytest.mark.benchmark(group=GROUP)
@pytest.mark.parametrize("n_samples", SAMPLES)
@pytest.mark.parametrize("node", NODES)
def test_the_servers_work(
    benchmark: BenchmarkFixture, handle: viser.ClientHandle, jaco: Jaco, node: str, n_samples: int
) -> None:
    measure(benchmark, handle, jaco, reaching(n_samples), node)


@pytest.mark.benchmark(group=GROUP)
@pytest.mark.parametrize("node", LINES)
def test_the_servers_work_for_a_correction(
    benchmark: BenchmarkFixture, handle: viser.ClientHandle, jaco: Jaco, node: str
) -> None:
    measure(benchmark, handle, jaco, reaching(SAMPLES[0]), node)


@pytest.mark.benchmark(group=GROUP)
def test_the_servers_work_for_a_replay_that_is_corrected(
    benchmark: BenchmarkFixture, handle: viser.ClientHandle, jaco: Jaco
) -> None:
    measure(benchmark, handle, jaco, reaching(SAMPLES[0]), "/hand", puller_of=Corrector)


@pytest.mark.benchmark(group=GROUP)
@pytest.mark.parametrize("node", ["/landmarks/goal", "/landmarks/box"])
def test_the_servers_work_with_four_landmarks_and_a_frame_among_them(
    benchmark: BenchmarkFixture, handle: viser.ClientHandle, jaco: Jaco, node: str
) -> None:
    measure(benchmark, handle, jaco, with_frame(reaching(SAMPLES[0])), node)


def measure(
    benchmark: BenchmarkFixture,
    handle: viser.ClientHandle,
    jaco: Jaco,
    document: Document,
    node: str,
    *,
    puller_of: type[Puller] = Puller,
) -> None:
    """Pull a node of a document's scene."""
    desk = Desk(document, jaco)
    desk.stage.pause()
    avoid_pauses()  # as `gc-teach serve` does
    viewer = viewers.working(handle, Notes(), jaco, time.monotonic, [])
    puller = puller_of(desk, viewer, node)

    benchmark.pedantic(puller.update, setup=puller.one_event, rounds=4 * EVENTS, warmup_rounds=10)

    benchmark.extra_info |= summary(benchmark.stats.stats.data)
    benchmark.extra_info |= {f"cpu_{name}": value for name, value in summary(puller.worked).items()}
    assert desk.state().dragging == node


@pytest.fixture(scope="module", params=SAMPLES)
def address(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A server in a process of its own, as people run it; its websocket address."""
    folder = tmp_path_factory.mktemp("served")
    recordings = folder / f"reaching-{request.param}.npz"
    files.write(recordings, [shown.demonstration for shown in reaching(request.param).demonstrations])
    library = f"sqlite:///{folder / 'library.db'}"
    command = [sys.executable, "-m", "app", "serve", str(recordings), "--port", "0", "--library", library]
    process = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    line = process.stdout.readline()
    yield line.split()[3].replace("http://", "ws://")
    process.terminate()
    process.wait(timeout=20.0)


@pytest.mark.benchmark(group="a drag update answered at the tab")
@pytest.mark.parametrize("node", NODES)
def test_the_answer_at_the_tab(benchmark: BenchmarkFixture, address: str, node: str) -> None:
    with FakeClient(f"{address}s/measured-{node.rpartition('/')[2]}") as client:
        client.wait_nodes("/tube", "/reproductions/0", node)
        client.wait(lambda c: offers(c, "Pause"))  # the playback begins a moment after the scene
        client.press("Pause")
        client.wait(lambda c: offers(c, "Play"))
        tab = Tab(client, node)

        benchmark.pedantic(tab.answered, setup=tab.next_event, rounds=EVENTS - 8)

    benchmark.extra_info |= summary(benchmark.stats.stats.data)


def offers(client: FakeClient, option: str) -> bool:
    """Whether some group of buttons has this option now."""
    return any(option in element.props.get("options", ()) for element in client.gui)


class Tab:
    """A person pulling at a browser's pace, who watches the tube."""

    def __init__(self, client: FakeClient, node: str) -> None:
        self.client, self.node = client, node
        self.at = client.world_position(node)
        self.way = iter(way_of(node, self.at, EVENTS))
        self.owner = client.node(node).owner
        self.sent = time.perf_counter()
        self.send("start", self.at)
        for _ in range(5):  # the first centimetres of the hand change no tube
            self.send("update", next(self.way))
            threading.Event().wait(EVENT)

    def next_event(self) -> None:
        """Wait until it is time for the next event, as a browser does."""
        threading.Event().wait(max(0.0, self.sent + EVENT - time.perf_counter()))
        self.pointer = next(self.way)
        self.before = self.client.node("/tube").props["vertices"]
        self.sent = time.perf_counter()

    def answered(self) -> None:
        """Send an event and wait for another tube.

        A pulled hand moves between events, too: its next tube is sometimes that of a tick already under way.
        """
        self.send("update", self.pointer)
        self.client.wait(lambda c: c.node("/tube").props["vertices"] is not self.before)

    def send(self, phase: str, pointer: FloatArray) -> None:
        """One event of the pull."""
        self.client.send(
            "SceneNodeDragMessage",
            phase=phase,
            name=self.node,
            instance_index=None,
            start_position=tuple(map(float, self.at)),
            start_screen_pos=(0.5, 0.5),
            end_position=tuple(map(float, pointer)),
            end_screen_pos=(0.5, 0.5),
            button="left",
            modifier=None,
            owner=self.owner,
        )


def summary(seconds: list[float]) -> dict[str, float]:
    """Median and 95th percentile [ms]."""
    median, p95 = 1000.0 * np.percentile(seconds, [50.0, 95.0])
    return {"median_ms": round(float(median), 1), "p95_ms": round(float(p95), 1)}
