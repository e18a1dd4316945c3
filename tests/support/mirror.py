"""What one viser 1.1.1 client knows: the scene and the GUI, rebuilt from the messages it was sent.

A frame on the wire is: u64 length of the msgpack, u64 length of its zstd form, that zstd form, then the
arrays as raw bytes, each padded to 8 bytes. Arrays arrive flat; their shape is the reader's knowledge.
Values in the mirror are replaced, never changed, so that what a test took out stays as it was.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import msgspec
import numpy as np
import zstandard

Message = dict[str, Any]


@dataclass(frozen=True)
class Node:
    """One scene node as this client holds it."""

    name: str
    kind: str
    """The message that made it, e.g. ``"MeshMessage"``."""
    owner: str
    """``""`` for ``server.scene``, else the client's id."""
    virtual: bool
    props: Mapping[str, Any]
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """In the parent's frame [m]."""
    wxyz: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    visible: bool = True
    drags: frozenset[tuple[str, str | None]] = frozenset()
    """(button, modifier) pairs that the node listens to."""
    clicks: frozenset[tuple[str, str | None]] = frozenset()

    def array(self, prop: str, *shape: int) -> np.ndarray:
        """One array property in its shape, e.g. ``node.array("vertices", -1, 3)``."""
        return np.asarray(self.props[prop]).reshape(shape or (-1, 3))


@dataclass(frozen=True)
class Element:
    """One GUI element as this client holds it."""

    uuid: str
    kind: str
    """The message that made it without ``Gui`` and ``Message``, e.g. ``"Slider"``."""
    container: str
    props: Mapping[str, Any]
    value: Any = None

    @property
    def label(self) -> str:
        return str(self.props.get("label") or "")

    @property
    def usable(self) -> bool:
        """Whether a person could use it: shown and not greyed out."""
        return bool(self.props.get("visible", True)) and not self.props.get("disabled", False)


@dataclass
class Mirror:
    """The state of one client; `apply` is its only way to change."""

    variants: dict[tuple[str, str], Node] = field(default_factory=dict)
    """By (name, owner)."""
    gui: dict[str, Element] = field(default_factory=dict)
    """By uuid."""
    notices: list[tuple[str, str]] = field(default_factory=list)
    """(title, body) of every notification so far, oldest first."""
    modals: dict[str, str] = field(default_factory=dict)
    """Title by uuid of the modals that are open."""
    commands: dict[str, Mapping[str, Any]] = field(default_factory=dict)
    """Properties by uuid of the keyboard commands."""
    uploaded: dict[str, int] = field(default_factory=dict)
    """Bytes that the server has acknowledged, by transfer."""
    downloads: dict[str, tuple[str, bytes]] = field(default_factory=dict)
    """Name and content so far, by transfer."""
    theme: Mapping[str, Any] = field(default_factory=dict)
    scene_clicks: bool = False
    """Whether the server wants to hear of clicks anywhere in the scene."""

    def nodes(self) -> dict[str, Node]:
        """The variant of every node that a page would draw, by name."""
        drawn: dict[str, Node] = {}
        for node in sorted(self.variants.values(), key=lambda n: (not n.virtual, n.owner != "")):
            drawn[node.name] = node
        return drawn

    def apply(self, message: Message) -> None:
        """Take in one message of the server."""
        handler = _HANDLERS.get(message["type"])
        if handler is not None:
            handler(self, message)
        elif "props" in message and "name" in message:
            _create_node(self, message)
        elif message["type"].startswith("Gui") and "props" in message and "uuid" in message:
            _create_element(self, message)


def decode_frame(raw: bytes) -> list[Message]:
    """The messages of one websocket frame from the server, arrays put back (flat, read-only)."""
    n_inner, n_packed = (int(n) for n in np.frombuffer(raw, "<u8", 2))
    packed = raw[16 : 16 + n_packed]
    inner = msgspec.msgpack.decode(zstandard.ZstdDecompressor().decompress(packed, max_output_size=n_inner))
    spans: list[tuple[int, int]] = []
    offset = 16 + n_packed
    for length in inner["binaryBufferLengths"]:
        offset += -offset % 8
        spans.append((offset, length))
        offset += length
    return [_with_arrays(message, raw, spans) for message in inner["messages"]]


def _with_arrays(value: Any, raw: bytes, spans: list[tuple[int, int]]) -> Any:
    if isinstance(value, dict):
        if "__binary_index" in value:
            offset, length = spans[value["__binary_index"]]
            dtype = np.dtype(value["dtype"])
            return np.frombuffer(raw, dtype, count=length // dtype.itemsize, offset=offset)
        return {key: _with_arrays(item, raw, spans) for key, item in value.items()}
    if isinstance(value, list):
        return [_with_arrays(item, raw, spans) for item in value]
    return value


def _create_node(mirror: Mirror, message: Message) -> None:
    key = (message["name"], message.get("owner", ""))
    mirror.variants[key] = Node(
        name=message["name"],
        kind=message["type"],
        owner=message.get("owner", ""),
        virtual=bool(message.get("virtual", False)),
        props=message["props"],
    )


def _create_element(mirror: Mirror, message: Message) -> None:
    mirror.gui[message["uuid"]] = Element(
        uuid=message["uuid"],
        kind=message["type"].removeprefix("Gui").removesuffix("Message"),
        container=message.get("container_uuid", ""),
        props=message["props"],
        value=message.get("value"),
    )


def _change_node(mirror: Mirror, message: Message, **changes: Any) -> None:
    key = (message["name"], message.get("owner", ""))
    if key in mirror.variants:
        mirror.variants[key] = replace(mirror.variants[key], **changes)


def _bindings(message: Message) -> frozenset[tuple[str, str | None]]:
    return frozenset((b["button"], b["modifier"]) for b in message["bindings"])


def _on_node_update(mirror: Mirror, message: Message) -> None:
    node = mirror.variants.get((message["name"], message.get("owner", "")))
    if node is not None:
        _change_node(mirror, message, props={**node.props, **message["updates"]})


def _on_gui_update(mirror: Mirror, message: Message) -> None:
    element = mirror.gui.get(message["uuid"])
    if element is None:
        return
    updates = dict(message["updates"])
    value = updates.pop("value", element.value)
    mirror.gui[element.uuid] = replace(element, value=value, props={**element.props, **updates})


def _on_command_update(mirror: Mirror, message: Message) -> None:
    old = mirror.commands.get(message["uuid"])
    if old is not None:
        mirror.commands[message["uuid"]] = {**old, **message["updates"]}


def _on_notice(mirror: Mirror, message: Message) -> None:
    mirror.notices.append((message["props"]["title"], message["props"]["body"]))


def _on_download(mirror: Mirror, message: Message) -> None:
    mirror.downloads[message["transfer_uuid"]] = (message["filename"], b"")


def _on_part(mirror: Mirror, message: Message) -> None:
    name, content = mirror.downloads[message["transfer_uuid"]]
    mirror.downloads[message["transfer_uuid"]] = (name, content + bytes(message["content"]))


def _on_scene_pointer(mirror: Mirror, message: Message) -> None:
    if message["event_type"] == "click":
        mirror.scene_clicks = bool(message["modifiers"])


_HANDLERS = {
    "ScenePointerEnableMessage": _on_scene_pointer,
    "RemoveSceneNodeMessage": lambda s, m: s.variants.pop((m["name"], m.get("owner", "")), None),
    "SceneNodeUpdateMessage": _on_node_update,
    "SetPositionMessage": lambda s, m: _change_node(s, m, position=tuple(m["position"])),
    "SetOrientationMessage": lambda s, m: _change_node(s, m, wxyz=tuple(m["wxyz"])),
    "SetSceneNodeVisibilityMessage": lambda s, m: _change_node(s, m, visible=m["visible"]),
    "SetSceneNodeDragBindingsMessage": lambda s, m: _change_node(s, m, drags=_bindings(m)),
    "SetSceneNodeClickBindingsMessage": lambda s, m: _change_node(s, m, clicks=_bindings(m)),
    "GuiUpdateMessage": _on_gui_update,
    "GuiRemoveMessage": lambda s, m: s.gui.pop(m["uuid"], None),
    "GuiPanelRemoveMessage": lambda s, m: s.gui.pop(m["uuid"], None),
    "ResetGuiMessage": lambda s, _: s.gui.clear(),
    "GuiModalMessage": lambda s, m: s.modals.__setitem__(m["uuid"], m["title"]),
    "GuiCloseModalMessage": lambda s, m: s.modals.pop(m["uuid"], None),
    "NotificationShowMessage": _on_notice,
    "NotificationUpdateMessage": _on_notice,
    "RegisterCommandMessage": lambda s, m: s.commands.__setitem__(m["uuid"], m["props"]),
    "CommandUpdateMessage": _on_command_update,
    "RemoveCommandMessage": lambda s, m: s.commands.pop(m["uuid"], None),
    "FileTransferStartDownload": _on_download,
    "FileTransferPart": _on_part,
    "FileTransferPartAck": lambda s, m: s.uploaded.__setitem__(m["transfer_uuid"], m["transferred_bytes"]),
    "ThemeConfigurationMessage": lambda s, m: setattr(s, "theme", m),
}
