"""A viser 1.1.1 client without a browser, for tests in milliseconds.

Plain blocking calls: a thread of its own reads the socket into a `Mirror`, and `wait` sleeps on a condition
until the mirror shows what the test asks for. It does what a page does and no more: it refuses to press a
button that a person could not press.

    with FakeClient(f"ws://127.0.0.1:{server.get_port()}/s/abcdefghij") as client:
        client.wait_nodes("/hand")
        client.drag("/hand", [(0.1, 0.0, 0.3), (0.2, 0.0, 0.3)])
        client.wait(lambda c: c.node("/tube").visible)
"""

from __future__ import annotations

import contextlib
import threading
import time
import uuid
from collections.abc import Callable, Iterator, Mapping, Sequence
from types import TracebackType
from typing import Any

import msgspec
import numpy as np
import viser
from viser import transforms
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect
from websockets.typing import Origin, Subprotocol

from tests.support.mirror import Element, Message, Mirror, Node, decode_frame

Point = Sequence[float]
CAMERA = (3.0, 3.0, 3.0)
CHUNK = 512 * 1024
"""Bytes in one part of an upload, as in viser's page."""


class FakeClient:
    """One tab: connects on entering, closes on leaving."""

    def __init__(
        self,
        url: str,
        *,
        origin: str | None = None,
        headers: Mapping[str, str] | None = None,
        keep_log: bool = False,
    ) -> None:
        self.url = url
        self._headers = headers
        self.bytes_received = 0
        self.frames_received = 0
        self.messages_received = 0
        self.connected_at = 0.0
        """``time.perf_counter()`` when the socket was open [s]; so are the next two."""
        self.first_message_at: float | None = None
        self.last_message_at: float | None = None
        self.closed: tuple[int, str] | None = None
        """Code and reason, once the connection is gone."""
        self.log: list[Message] = []
        """Every message, when asked for by ``keep_log``."""
        self.storage: dict[str, str] = {}
        self._origin = Origin(origin) if origin is not None else None
        self._keep_log = keep_log
        self._mirror = Mirror()
        self._news = threading.Condition()

    # --- connection -----------------------------------------------------------------------------------

    def __enter__(self) -> FakeClient:
        self._socket = connect(
            self.url,
            subprotocols=[Subprotocol(f"viser-v{viser.__version__}")],
            origin=self._origin,
            additional_headers=self._headers,
            max_size=None,
            compression=None,
            close_timeout=2.0,
        )
        self.connected_at = time.perf_counter()
        self._reader = threading.Thread(target=self._read, name="fake-client", daemon=True)
        self._reader.start()
        # viser calls on_client_connect only after a first camera.
        self.send_camera(CAMERA)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Leave, as a closed tab does."""
        self._socket.close()
        self._reader.join(timeout=5.0)

    def send(self, kind: str, **fields: Any) -> None:
        """Send one message of viser's protocol, unchecked."""
        self._socket.send(msgspec.msgpack.encode({"type": kind, **fields}))

    def send_raw(self, frame: bytes | str) -> None:
        """Send anything at all."""
        self._socket.send(frame)

    def send_camera(self, position: Point, look_at: Point = (0.0, 0.0, 0.0)) -> None:
        """Say where this tab's camera is [m]."""
        self.send(
            "ViewerCameraMessage",
            wxyz=(1.0, 0.0, 0.0, 0.0),
            position=_floats(position),
            fov=1.3,
            near=0.01,
            far=1000.0,
            image_height=720,
            image_width=1280,
            look_at=_floats(look_at),
            up_direction=(0.0, 0.0, 1.0),
        )

    # --- what it shows --------------------------------------------------------------------------------

    @property
    def nodes(self) -> dict[str, Node]:
        """What the page would draw, by name; a copy."""
        with self._news:
            return self._mirror.nodes()

    @property
    def gui(self) -> list[Element]:
        """Every GUI element; a copy."""
        with self._news:
            return list(self._mirror.gui.values())

    @property
    def notices(self) -> list[tuple[str, str]]:
        """(title, body) of every notification so far."""
        with self._news:
            return list(self._mirror.notices)

    @property
    def modals(self) -> list[str]:
        """Titles of the open modals."""
        with self._news:
            return list(self._mirror.modals.values())

    @property
    def downloads(self) -> dict[str, bytes]:
        """Content of the files that were sent to be saved, as far as it came, by name."""
        with self._news:
            return dict(self._mirror.downloads.values())

    @property
    def commands(self) -> list[str]:
        """Labels of the keyboard commands."""
        with self._news:
            return [str(props["label"]) for props in self._mirror.commands.values()]

    def node(self, name: str) -> Node:
        """One node; KeyError names those there are."""
        nodes = self.nodes
        if name not in nodes:
            raise KeyError(f"no node {name}; there are {sorted(nodes)}")
        return nodes[name]

    def world_position(self, name: str) -> np.ndarray:
        """(3,) origin of a node in the world [m], its parents' poses included."""
        nodes, pose, parts = self.nodes, transforms.SE3.identity(), name.split("/")
        for count in range(2, len(parts) + 1):
            node = nodes.get("/".join(parts[:count]))
            if node is not None:
                turn = transforms.SO3(np.asarray(node.wxyz))
                pose = pose @ transforms.SE3.from_rotation_and_translation(turn, np.asarray(node.position))
        return pose.translation()

    def element(self, label: str, kind: str | None = None) -> Element:
        """The GUI element with this label; LookupError when there is none or more than one."""
        found = [e for e in self.gui if e.label == label and kind in (None, e.kind)]
        shown = [e for e in found if e.usable] or found
        if len(shown) != 1:
            labels = sorted({f"{e.kind} {e.label!r}" for e in self.gui if e.label})
            raise LookupError(f"{len(shown)} elements are called {label!r}; there are {labels}")
        return shown[0]

    def value(self, label: str, kind: str | None = None) -> Any:
        """What the element with this label shows."""
        return self.element(label, kind).value

    def text(self) -> str:
        """All markdown and HTML in the GUI, joined by newlines."""
        parts = [e.props.get("_markdown") or e.props.get("content") or "" for e in self.gui]
        return "\n".join(str(part) for part in parts if part)

    # --- waiting --------------------------------------------------------------------------------------

    def wait(self, condition: Callable[[FakeClient], Any], timeout: float = 10.0) -> Any:
        """Wait until ``condition(self)`` is true and return it; it is asked after every frame."""
        with self._news:
            found = self._news.wait_for(lambda: _try(condition, self) or self.closed, timeout)
            result = _try(condition, self)
        if not result:
            state = f"closed: {self.closed}" if found else f"{timeout} s passed"
            raise TimeoutError(f"{state}; nodes {sorted(self.nodes)}; notices {self.notices}")
        return result

    def wait_nodes(self, *names: str, timeout: float = 10.0) -> None:
        """Wait until all these nodes are there."""
        self.wait(lambda c: set(names) <= set(c.nodes), timeout)

    def wait_quiet(self, seconds: float = 0.2, timeout: float = 20.0) -> None:
        """Wait until no message came for so long."""
        end = time.perf_counter() + timeout
        with self._news:
            while True:
                seen = self.frames_received
                if not self._news.wait_for(lambda seen=seen: self.frames_received != seen, seconds):
                    return
                if time.perf_counter() > end:
                    raise TimeoutError(f"messages still came after {timeout} s")

    # --- hands ----------------------------------------------------------------------------------------

    def drag(
        self,
        name: str,
        points: Sequence[Point],
        modifier: str | None = None,
        button: str = "left",
        *,
        interval: float = 0.0,
    ) -> None:
        """Press on a node, pull it through `points` (world, [m]) and let go.

        `interval` is the real time between two points [s]; a browser sends one each 0.05 s.
        """
        with self.dragging(name, modifier, button) as move:
            for point in points:
                move(point)
                if interval:
                    threading.Event().wait(interval)

    @contextlib.contextmanager
    def dragging(
        self, name: str, modifier: str | None = None, button: str = "left"
    ) -> Iterator[Callable[[Point], None]]:
        """A drag in the hand: yields ``move(point)``; letting go at the end of the block."""
        node = self.node(name)
        if (button, modifier) not in node.drags:
            raise LookupError(f"{name} does not listen to {(button, modifier)}, only to {set(node.drags)}")
        at = [_floats(self.world_position(name))]

        def say(phase: str) -> None:
            self.send(
                "SceneNodeDragMessage",
                phase=phase,
                name=name,
                instance_index=None,
                start_position=_floats(self.world_position(name)) if name in self.nodes else at[0],
                start_screen_pos=(0.5, 0.5),
                end_position=at[0],
                end_screen_pos=(0.5, 0.5),
                button=button,
                modifier=modifier,
                owner=node.owner,
            )

        def move(point: Point) -> None:
            at[0] = _floats(point)
            say("update")

        say("start")
        yield move
        say("end")

    def drag_gizmo(self, name: str, points: Sequence[Point], wxyz: Point = (1.0, 0.0, 0.0, 0.0)) -> None:
        """Move a transform gizmo through `points` (its parent's frame, [m])."""
        owner = self.node(name).owner
        self.send("TransformControlsDragStartMessage", name=name, owner=owner)
        for point in points:
            self.send(
                "TransformControlsUpdateMessage",
                name=name,
                position=_floats(point),
                wxyz=_floats(wxyz),
                owner=owner,
            )
        self.send("TransformControlsDragEndMessage", name=name, owner=owner)

    def click(self, name: str, modifier: str | None = None, at: Point | None = None) -> None:
        """Click on a node; the ray goes from the camera to `at` (world, [m]) or the node's origin."""
        node = self.node(name)
        if ("left", modifier) not in node.clicks:
            raise LookupError(f"{name} listens to no such click, only to {set(node.clicks)}")
        target = self.world_position(name) if at is None else np.asarray(at, float)
        ray = target - np.asarray(CAMERA)
        self.send(
            "SceneNodeClickMessage",
            name=name,
            instance_index=None,
            ray_origin=CAMERA,
            ray_direction=_floats(ray / np.linalg.norm(ray)),
            screen_pos=(0.5, 0.5),
            modifier=modifier,
            owner=node.owner,
        )

    def click_scene(self, at: Point) -> None:
        """Click wherever `at` (world, [m]) is seen; refused while nobody listens to such clicks."""
        if not self._mirror.scene_clicks:
            raise LookupError("nobody listens to clicks in the scene")
        ray = np.asarray(at, float) - np.asarray(CAMERA)
        self.send(
            "ScenePointerMessage",
            event_type="click",
            ray_origin=CAMERA,
            ray_direction=_floats(ray / np.linalg.norm(ray)),
            screen_pos=((0.5, 0.5),),
            modifier=None,
        )

    @property
    def hears_clicks(self) -> bool:
        """Whether a click anywhere in the scene would be heard."""
        with self._news:
            return self._mirror.scene_clicks

    def set_gui(self, label: str, value: Any, kind: str | None = None) -> None:
        """Set a slider, checkbox, dropdown, text or number by its label."""
        element = self._usable(label, kind)
        update = {"type": "GuiUpdateMessage", "uuid": element.uuid, "updates": {"value": value}}
        with self._news:
            self._mirror.apply(update)
        self.send("GuiUpdateMessage", uuid=element.uuid, updates={"value": value})

    def press(self, label: str) -> None:
        """Press a button, or the option with this label of a button group."""
        groups = [e for e in self.gui if e.kind == "ButtonGroup" and label in e.props.get("options", ())]
        if len(groups) == 1 and groups[0].usable:
            self.send("GuiUpdateMessage", uuid=groups[0].uuid, updates={"value": label})
            return
        element = self._usable(label, "Button")
        self.send("GuiUpdateMessage", uuid=element.uuid, updates={"value": True})

    def trigger(self, label: str) -> None:
        """Use a keyboard command by its label."""
        with self._news:
            found = {u: p for u, p in self._mirror.commands.items() if p["label"] == label}
        if len(found) != 1 or next(iter(found.values()))["disabled"]:
            raise LookupError(f"no usable command {label!r}; there are {self.commands}")
        self.send("CommandTriggerMessage", uuid=next(iter(found)))

    def upload(self, label: str, name: str, content: bytes, *, announced: int | None = None) -> str:
        """Give a file to an upload button; returns the transfer for `uploaded`."""
        element, transfer = self._usable(label, "UploadButton"), str(uuid.uuid4())
        chunks = [content[i : i + CHUNK] for i in range(0, len(content), CHUNK)]
        self.send(
            "FileTransferStartUpload",
            source_component_uuid=element.uuid,
            transfer_uuid=transfer,
            filename=name,
            mime_type="application/octet-stream",
            part_count=len(chunks),
            size_bytes=len(content) if announced is None else announced,
        )
        for index, chunk in enumerate(chunks):
            self.send(
                "FileTransferPart",
                source_component_uuid=element.uuid,
                transfer_uuid=transfer,
                part_index=index,
                content=chunk,
            )
        return transfer

    def uploaded(self, transfer: str) -> int:
        """How many bytes of a transfer the server has acknowledged."""
        with self._news:
            return self._mirror.uploaded.get(transfer, -1)

    # --- the reading thread ---------------------------------------------------------------------------

    def _usable(self, label: str, kind: str | None) -> Element:
        element = self.element(label, kind)
        if not element.usable:
            raise LookupError(f"{label!r} is hidden or greyed out; a person could not use it")
        return element

    def _read(self) -> None:
        try:
            for raw in self._socket:
                self._take(raw if isinstance(raw, bytes) else raw.encode())
        except ConnectionClosed:
            pass
        finally:
            with self._news:
                code = self._socket.protocol.close_code
                self.closed = (1006 if code is None else code, self._socket.protocol.close_reason or "")
                self._news.notify_all()

    def _take(self, raw: bytes) -> None:
        now, messages = time.perf_counter(), decode_frame(raw)
        with self._news:
            self.first_message_at = self.first_message_at or now
            self.last_message_at = now
            self.bytes_received += len(raw)
            self.frames_received += 1
            self.messages_received += len(messages)
            for message in messages:
                self._mirror.apply(message)
                if self._keep_log:
                    self.log.append(message)
            self._news.notify_all()
        for message in messages:
            self._answer(message)

    def _answer(self, message: Message) -> None:
        """Local storage, which the server reads through the page."""
        if message["type"] == "LocalStorageSetItemMessage":
            self.storage[message["key"]] = message["value"]
        elif message["type"] == "LocalStorageGetItemRequestMessage":
            self.send(
                "LocalStorageGetItemResponseMessage",
                value=self.storage.get(message["key"]),
                error=None,
                request_uuid=message["request_uuid"],
            )


def _floats(values: Sequence[float] | np.ndarray) -> tuple[float, ...]:
    return tuple(float(v) for v in values)


def _try(condition: Callable[[FakeClient], Any], client: FakeClient) -> Any:
    """A condition about something that is not there yet is not true yet."""
    try:
        return condition(client)
    except LookupError:
        return None
