"""SDO server after CiA 301: expedited and segmented transfer; block transfer is refused.

Job: turn request frames into answers, with the right abort codes. Not its job: frames on the bus, timing
other than the server's own time-out of a segmented transfer (`expire`).
"""

from __future__ import annotations

import struct

from sim_hardware.bench.can import datatypes
from sim_hardware.bench.can.dictionary import Abort, AbortCode, ObjectDictionary

REQUEST_BYTES = 8
MAX_TRANSFER_BYTES = 4096

_DOWNLOAD_SEGMENT, _DOWNLOAD, _UPLOAD, _UPLOAD_SEGMENT, _ABORT = 0, 1, 2, 3, 4


class SdoServer:
    """One SDO channel of a node.

    Parameters
    ----------
    dictionary : ObjectDictionary
    """

    def __init__(self, dictionary: ObjectDictionary) -> None:
        self._dictionary = dictionary
        self._index, self._sub = 0, 0
        self._download: bytearray | None = None
        self._announced_bytes: int | None = None
        self._upload: bytes | None = None
        self._toggle = 0

    @property
    def busy(self) -> bool:
        """A segmented transfer is under way."""
        return self._download is not None or self._upload is not None

    def reset(self) -> None:
        """Forget a transfer that is under way."""
        self._download, self._upload, self._announced_bytes, self._toggle = None, None, None, 0

    def expire(self) -> bytes | None:
        """The client has been silent for too long: abort of the transfer under way."""
        return self._abort(AbortCode.TIMED_OUT) if self.busy else None

    def request(self, data: bytes) -> bytes | None:
        """Answer to a request of the client; None where the standard asks for none."""
        if len(data) != REQUEST_BYTES:
            return None
        command = data[0] >> 5
        try:
            if command == _ABORT:
                self.reset()
                return None
            if command in (_DOWNLOAD, _UPLOAD):
                self.reset()
                _, self._index, self._sub = struct.unpack_from("<BHB", data)
                return self._start_download(data) if command == _DOWNLOAD else self._start_upload()
            if command == _DOWNLOAD_SEGMENT:
                return self._download_segment(data)
            if command == _UPLOAD_SEGMENT:
                return self._upload_segment(data)
            if not self.busy:
                _, self._index, self._sub = struct.unpack_from("<BHB", data)
            raise Abort(AbortCode.BAD_COMMAND)
        except Abort as abort:
            return self._abort(abort.code)

    def _abort(self, code: AbortCode) -> bytes:
        self.reset()
        return struct.pack("<BHBI", 0x80, self._index, self._sub, code)

    # -- download: client writes ------------------------------------------------------------------

    def _start_download(self, data: bytes) -> bytes:
        expedited, sized = data[0] & 0x02, data[0] & 0x01
        if expedited:
            if sized:
                value = data[4 : 8 - (data[0] >> 2 & 3)]
            else:  # length not told: that of the object's type
                size = datatypes.size_bytes(self._dictionary.find(self._index, self._sub).kind)
                value = data[4 : 4 + min(4, size or 4)]
            self._dictionary.write(self._index, self._sub, value)
        else:
            entry = self._dictionary.find(self._index, self._sub)
            if not entry.writable:
                raise Abort(AbortCode.READ_ONLY)
            self._announced_bytes = struct.unpack_from("<I", data, 4)[0] if sized else None
            if self._announced_bytes is not None and self._announced_bytes > MAX_TRANSFER_BYTES:
                raise Abort(AbortCode.OUT_OF_MEMORY)
            self._download = bytearray()
        return struct.pack("<BHB4x", 0x60, self._index, self._sub)

    def _download_segment(self, data: bytes) -> bytes:
        if self._download is None:
            raise Abort(AbortCode.BAD_COMMAND)
        if (data[0] >> 4 & 1) != self._toggle:
            raise Abort(AbortCode.TOGGLE)
        self._download += data[1 : 8 - (data[0] >> 1 & 7)]
        if len(self._download) > MAX_TRANSFER_BYTES:
            raise Abort(AbortCode.OUT_OF_MEMORY)
        answer = bytes([0x20 | self._toggle << 4, 0, 0, 0, 0, 0, 0, 0])
        self._toggle ^= 1
        if data[0] & 1:
            value, announced = bytes(self._download), self._announced_bytes
            self.reset()
            if announced is not None and announced != len(value):
                raise Abort(AbortCode.WRONG_LENGTH)
            self._dictionary.write(self._index, self._sub, value)
        return answer

    # -- upload: client reads ---------------------------------------------------------------------

    def _start_upload(self) -> bytes:
        value = self._dictionary.read(self._index, self._sub)
        if 1 <= len(value) <= 4:
            head = 0x43 | (4 - len(value)) << 2
            return struct.pack("<BHB4s", head, self._index, self._sub, value)
        self._upload = value
        return struct.pack("<BHBI", 0x41, self._index, self._sub, len(value))

    def _upload_segment(self, data: bytes) -> bytes:
        if self._upload is None:
            raise Abort(AbortCode.BAD_COMMAND)
        if (data[0] >> 4 & 1) != self._toggle:
            raise Abort(AbortCode.TOGGLE)
        part, self._upload = self._upload[:7], self._upload[7:]
        last = not self._upload
        head = self._toggle << 4 | (7 - len(part)) << 1 | last
        self._toggle ^= 1
        if last:
            self.reset()
        return bytes([head]) + part.ljust(7, b"\0")
