"""What a tab may send to viser: uploads that were allowed, and values of GUI elements, nothing else of them.

viser 1.1.1 lets any tab name any attribute of a GUI element in an update, its list of callbacks included,
and takes uploads of any size for any element. Both handlers are replaced here by ones that look first; those
of the public share tunnel are taken away.
"""

# pyright: reportPrivateUsage=false
# As in app.web: viser has no public way to do this.

from collections.abc import Callable, Coroutine
from typing import Any, Protocol, cast

import viser
from viser import _messages as messages

from app.uploads import Announcement, UploadLedger

OnRefused = Callable[[int, str, int], None]
"""Called with (client id, file name, announced bytes) on viser's event loop: it must only post."""


class _Handlers(Protocol):
    """What viser's connections have in common; its own annotations leave the callbacks unknown."""

    def register_handler(self, message_cls: type, callback: Callable[[Any, Any], object]) -> None: ...
    def unregister_handler(
        self, message_cls: type, callback: Callable[[Any, Any], object] | None = None
    ) -> None: ...


def guard(server: viser.ViserServer, upload_limit: int, on_refused: OnRefused | None) -> None:
    """Guard what all tabs share now, and what a tab has of its own when it comes.

    Parameters
    ----------
    server
        A server to which no other callback was added yet, so that the guard is there before them.
    upload_limit
        Most bytes that one tab may be sending at a time.
    on_refused
        Told of each refused upload.
    """
    shared = cast(_Handlers, server._websock_server)
    for message in (messages.ShareUrlRequest, messages.ShareUrlDisconnect):
        shared.unregister_handler(message)
    for message in (messages.FileTransferStartUpload, messages.FileTransferPart):
        shared.unregister_handler(message)  # nothing is uploaded to what all tabs share
    _guard_values(shared, server.gui)

    @server.on_client_connect
    async def _(client: viser.ClientHandle) -> None:
        _guard_values(cast(_Handlers, client._websock_connection), client.gui)
        _guard_uploads(client, UploadLedger(upload_limit), on_refused)


def _guard_values(connection: _Handlers, gui: viser.GuiApi) -> None:
    """Let updates through that change nothing but a value."""
    inner: Callable[[Any, messages.GuiUpdateMessage], Coroutine[Any, Any, None]] = gui._handle_gui_updates

    async def update(client_id: Any, message: messages.GuiUpdateMessage) -> None:
        if set(message.updates) == {"value"}:
            await inner(client_id, message)

    connection.unregister_handler(messages.GuiUpdateMessage, inner)
    connection.register_handler(messages.GuiUpdateMessage, update)


def _guard_uploads(client: viser.ClientHandle, ledger: UploadLedger, on_refused: OnRefused | None) -> None:
    """Put a ledger before viser's upload handlers of one tab."""

    def start(client_id: Any, message: messages.FileTransferStartUpload) -> None:
        if ledger.start(_announcement(client, message)):
            client.gui._handle_file_transfer_start(client_id, message)
            return
        _dismiss(client, message)
        if on_refused is not None:
            on_refused(int(client_id), str(message.filename), message.size_bytes)

    def part(client_id: Any, message: messages.FileTransferPart) -> None:
        transfer, size = str(message.transfer_uuid), _length(message.content)
        kept_its_word = ledger.take(transfer, size)
        if kept_its_word:
            client.gui._handle_file_transfer_part(client_id, message)
        if not kept_its_word or ledger.finished(transfer):
            ledger.close(transfer)
            # viser forgets a complete upload itself; an incomplete one would stay until the tab closes.
            client.gui._current_file_upload_states.pop(transfer, None)

    connection = cast(_Handlers, client._websock_connection)
    connection.unregister_handler(messages.FileTransferStartUpload)
    connection.unregister_handler(messages.FileTransferPart)
    connection.register_handler(messages.FileTransferStartUpload, start)
    connection.register_handler(messages.FileTransferPart, part)


def _announcement(client: viser.ClientHandle, message: messages.FileTransferStartUpload) -> Announcement:
    handle = client.gui._gui_input_handle_from_uuid.get(str(message.source_component_uuid))
    usable = isinstance(handle, viser.GuiUploadButtonHandle) and handle.visible and not handle.disabled
    return Announcement(
        transfer=str(message.transfer_uuid),
        name=str(message.filename),
        size=message.size_bytes,
        parts=message.part_count,
        target_takes_files=usable,
    )


def _length(content: object) -> int:
    return len(content) if isinstance(content, bytes) else 0


def _dismiss(client: viser.ClientHandle, message: messages.FileTransferStartUpload) -> None:
    """Free the button and take away the progress bar, which the page would else keep for ever."""
    queue = client._websock_connection.queue_message
    queue(
        messages.FileTransferPartAck(
            source_component_uuid=str(message.source_component_uuid),
            transfer_uuid=str(message.transfer_uuid),
            transferred_bytes=message.size_bytes,
            total_bytes=message.size_bytes,
        )
    )
    queue(messages.RemoveNotificationMessage(uuid=f"upload-{message.transfer_uuid}"))
