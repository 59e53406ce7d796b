"""Reads an exported recording and prints as JSON what is in it."""

import io
import json
import sys

from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from PIL import Image

found = {name: {} for name in ("messages", "stamps", "sizes", "calibrated", "metadata")}
found.update(inliers=[], lost=[], info=0, errors=0)


def nanoseconds(stamp):
    return stamp.seconds * 1_000_000_000 + stamp.nanos


with open(sys.argv[1], "rb") as file:
    reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
    found["metadata"] = {record.name: record.metadata for record in reader.iter_metadata()}
    for schema, channel, message, decoded in reader.iter_decoded_messages():
        topic = channel.topic
        assert decoded.DESCRIPTOR.full_name == schema.name, (decoded.DESCRIPTOR.full_name, schema.name)
        found["messages"][topic] = found["messages"].get(topic, 0) + 1
        found["stamps"].setdefault(topic, []).append(message.log_time)
        if hasattr(decoded, "timestamp"):
            assert nanoseconds(decoded.timestamp) == message.log_time, topic
        if schema.name == "foxglove.CompressedImage":
            image = Image.open(io.BytesIO(decoded.data))
            image.load()
            assert image.format.lower() == decoded.format, (image.format, decoded.format)
            found["sizes"].setdefault(topic, []).append(image.size)
        if schema.name == "foxglove.CameraCalibration":
            assert len(decoded.K) == 9 and len(decoded.R) == 9 and len(decoded.P) == 12
            found["calibrated"].setdefault(topic, []).append([decoded.width, decoded.height])
        if topic == "/localisation":
            found["inliers"].append(decoded.inliers if decoded.HasField("inliers") else None)
            found["lost"].append(decoded.lost)
        if topic == "/localisation/log":
            level = decoded.DESCRIPTOR.fields_by_name["level"].enum_type.values_by_number[decoded.level].name
            found["info"] += level == "INFO"
            found["errors"] += level == "ERROR"

print(json.dumps(found))
