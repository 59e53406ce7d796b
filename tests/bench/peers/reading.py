"""Writes a drive's images as a raw recording, or times how fast the messages of a recording are read.

    reading.py write DRIVE FILE     FILE is named by compression and container, as lz4.bag; prints its bytes of messages
    reading.py read FILE ROUNDS     prints the seconds of the fastest round
"""

import json
import sys
import time
from itertools import cycle, islice
from pathlib import Path

import numpy
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer as McapWriter
from PIL import Image
from rosbags.rosbag1 import Reader as BagReader, Writer as BagWriter
from rosbags.typesys import Stores, get_typestore

PAIRS = 320
RATE_HZ = 10
START_NS = 1_300_000_000_000_000_000
TYPE = "sensor_msgs/msg/Image"
SIDES = {"left": "image_00", "right": "image_01"}


def messages(drive, types):
    """Topic, stamp and message, pair by pair; the drive begins anew where it is too short."""
    names = "builtin_interfaces/msg/Time", "std_msgs/msg/Header", TYPE
    time_type, header_type, image_type = (types.types[name] for name in names)
    sequence = {"seq": 0} if "seq" in header_type.__dataclass_fields__ else {}
    sides = {side: sorted((drive / folder).iterdir()) for side, folder in SIDES.items()}
    for number, pair in enumerate(islice(cycle(zip(*sides.values())), PAIRS)):
        stamp_ns = START_NS + number * 10**9 // RATE_HZ
        stamp = time_type(sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9)
        for side, path in zip(sides, pair):
            pixels = numpy.array(Image.open(path))
            height, width = pixels.shape
            header = header_type(stamp=stamp, frame_id=side, **sequence)
            image = image_type(header, height, width, "mono8", 0, width, pixels.reshape(-1))
            yield f"/stereo/{side}/image_raw", stamp_ns, image


def write_bag(drive, path):
    types = get_typestore(Stores.ROS1_NOETIC)
    bag, topics, total = BagWriter(path), {}, 0
    if path.stem != "none":
        bag.set_compression(BagWriter.CompressionFormat[path.stem.upper()])
    with bag:
        for topic, stamp_ns, image in messages(drive, types):
            if topic not in topics:
                topics[topic] = bag.add_connection(topic, TYPE, typestore=types)
            data = types.serialize_ros1(image, TYPE)
            bag.write(topics[topic], stamp_ns, data)
            total += len(data)
    return total


def write_mcap(drive, path):
    types = get_typestore(Stores.ROS2_HUMBLE)
    topics, total = {}, 0
    with open(path, "wb") as file:
        writer = McapWriter(file, compression=CompressionType[path.stem.upper()])
        writer.start("ros2")
        schema = writer.register_schema(TYPE, "ros2msg", types.generate_msgdef(TYPE, ros_version=2)[0].encode())
        for topic, stamp_ns, image in messages(drive, types):
            if topic not in topics:
                topics[topic] = writer.register_channel(topic, "cdr", schema)
            data = bytes(types.serialize_cdr(image, TYPE))
            writer.add_message(topics[topic], stamp_ns, data, stamp_ns)
            total += len(data)
        writer.finish()
    return total


def write(drive, file):
    path = Path(file)
    return {"message_bytes": (write_bag if path.suffix == ".bag" else write_mcap)(Path(drive), path)}


def read_once(path):
    if path.suffix == ".bag":
        with BagReader(path) as bag:
            return sum(len(data) for _, _, data in bag.messages())
    with open(path, "rb") as file:
        reader = make_reader(file, validate_crcs=True)
        return sum(len(message.data) for _, _, message in reader.iter_messages())


def read(file, rounds):
    seconds = []
    for _ in range(int(rounds)):
        start = time.perf_counter()
        read_once(Path(file))
        seconds.append(time.perf_counter() - start)
    return {"seconds": min(seconds)}


command, *arguments = sys.argv[1:]
print(json.dumps({"write": write, "read": read}[command](*arguments)))
