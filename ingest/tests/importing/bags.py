# Bags of the datasets that come as such: ROS1's format 2.0 (wiki.ros.org/Bags/Format/2.0), a chunk a bag, no compression.
# Runs within layouts.py.


def field(name, value):
    body = name.encode() + b'=' + value
    return struct.pack('<I', len(body)) + body


def record(header, data):
    return struct.pack('<I', len(header)) + header + struct.pack('<I', len(data)) + data


def bag_time(ns):
    return struct.pack('<II', ns // 10**9, ns % 10**9)


def bag(path, messages):
    """messages: (topic, type, stamp, body after the header's stamp and frame), received 3 ms after their stamp."""
    topics = {topic: kind for topic, kind, _, _ in messages}
    numbers = {topic: number for number, topic in enumerate(topics)}
    def connection(topic):
        inner = field('topic', topic.encode()) + field('type', topics[topic].encode()) + field('md5sum', b'0' * 32) + field('message_definition', b'')
        return record(field('op', b'\x07') + field('conn', struct.pack('<I', numbers[topic])) + field('topic', topic.encode()), inner)
    chunk, index = b''.join(connection(topic) for topic in topics), {}
    for seq, (topic, _, ns, body) in enumerate(sorted(messages, key=lambda message: message[2])):
        data = struct.pack('<I', seq) + bag_time(ns) + struct.pack('<I', 3) + b'cam' + body
        index.setdefault(topic, []).append(bag_time(ns + 3_000_000) + struct.pack('<I', len(chunk)))
        chunk += record(field('op', b'\x02') + field('conn', struct.pack('<I', numbers[topic])) + field('time', bag_time(ns + 3_000_000)), data)
    head = b'#ROSBAG V2.0\n'
    head_length = 4096
    chunk_at = len(head) + head_length
    body = record(field('op', b'\x05') + field('compression', b'none') + field('size', struct.pack('<I', len(chunk))), chunk)
    for topic, entries in index.items():
        body += record(field('op', b'\x04') + field('ver', struct.pack('<I', 1)) + field('conn', struct.pack('<I', numbers[topic])) + field('count', struct.pack('<I', len(entries))), b''.join(entries))
    index_at = chunk_at + len(body)
    times = [ns + 3_000_000 for _, _, ns, _ in messages]
    counts = b''.join(struct.pack('<II', numbers[topic], len(entries)) for topic, entries in index.items())
    info = record(field('op', b'\x06') + field('ver', struct.pack('<I', 1)) + field('chunk_pos', struct.pack('<Q', chunk_at)) + field('start_time', bag_time(min(times))) + field('end_time', bag_time(max(times))) + field('count', struct.pack('<I', len(index))), counts)
    header = field('op', b'\x03') + field('index_pos', struct.pack('<Q', index_at)) + field('conn_count', struct.pack('<I', len(topics))) + field('chunk_count', struct.pack('<I', 1))
    padded = struct.pack('<I', len(header)) + header
    padded += struct.pack('<I', head_length - len(padded) - 4) + b' ' * (head_length - len(padded) - 4)
    put(path, head + padded + body + b''.join(connection(topic) for topic in topics) + info)


def image(topic, ns, side, i, w=W, h=H, colour=False):
    pixels = bytes((7 * x + 13 * y + 31 * i + (90 if side == 'right' else 0)) % 251 for y in range(h) for x in range(w))
    encoding, step = (b'bgr8', 3 * w) if colour else (b'mono8', w)
    data = b''.join(bytes([value] * 3) for value in pixels) if colour else pixels
    body = struct.pack('<III', h, w, len(encoding)) + encoding + struct.pack('<BII', 0, step, len(data)) + data
    return (topic, 'sensor_msgs/Image', ns, body)


def info(topic, ns, tx, w=W, h=H):
    k = [FX, 0, CX, 0, FX, CY, 0, 0, 1]
    p = [FX, 0, CX, tx, 0, FX, CY, 0, 0, 0, 1, 0]
    body = struct.pack('<III', h, w, 9) + b'plumb_bob' + struct.pack('<I5d', 5, *[0.0] * 5) + struct.pack('<9d', *k) + struct.pack('<9d', 1, 0, 0, 0, 1, 0, 0, 0, 1) + struct.pack('<12d', *p) + struct.pack('<IIIIII?', 0, 0, 0, 0, 0, 0, False)
    return (topic, 'sensor_msgs/CameraInfo', ns, body)


def fix(topic, ns, latitude, longitude):
    return (topic, 'sensor_msgs/NavSatFix', ns, struct.pack('<bH', 0, 1) + struct.pack('<3d', latitude, longitude, 30.0) + struct.pack('<9d', *[0.0] * 9) + b'\0')


def odometry(topic, ns, x):
    return (topic, 'nav_msgs/Odometry', ns, struct.pack('<I', 4) + b'base' + struct.pack('<7d', x, 0, 0, 0, 0, 0, 1) + struct.pack('<36d', *[0.0] * 36) + struct.pack('<6d', *[0.0] * 6) + struct.pack('<36d', *[0.0] * 36))


def pair(ns, i, left, right_topic, infos=None, size=(W, H), colours=(False, False)):
    messages = [image(left, ns, 'left', i, *size, colours[0]), image(right_topic, ns, 'right', i, *size, colours[1])]
    if infos:
        messages += [info(infos[0], ns, 0.0), info(infos[1], ns, -FX * BASE)]
    return messages


def citrusfarm():
    """Blocks by modality, all of one drive: two of the ZED, one of the base, one of the odometry, and one that is left out."""
    d = OUT / 'citrusfarm'
    zed = '/zed2i/zed_node'
    moments = lambda first, last: sum((pair(T0 + i * DT, i, f'{zed}/left/image_rect_color', f'{zed}/right/image_rect_color', (f'{zed}/left/camera_info', f'{zed}/right/camera_info'), colours=(True, True)) for i in range(first, last)), [])
    # In the order of names, the second block comes before the tenth.
    bag(d / 'zed_2023-07-18-14-26-49_10.bag', moments(3, N)), bag(d / 'zed_2023-07-18-14-26-49_9.bag', moments(0, 3))
    bag(d / 'base_2023-07-18-14-26-48_0.bag', [fix('/piksi/navsatfix_best_fix', T0 + i * DT, 33.96, -117.33) for i in range(N)])
    bag(d / 'odom_2023-07-18-14-26-48.bag', [odometry('/gps/fix/odometry', T0 + i * DT, float(i)) for i in range(N)])
    bag(d / 'mapir_2023-07-18-14-26-48_0.bag', [image('/mapir_cam/image_raw', T0 + i * DT, 'left', i) for i in range(N)])
    right['citrusfarm'] = dict(path='citrusfarm', pairs=N, stamps=stamps(), fx=FX, cx=CX, baseline=BASE, fixes=N, odometry=N)


def single_bag(name, file, left, right_topic, infos=None, size=(W, H), colours=(False, False), **told):
    bag(OUT / name / file, sum((pair(t, i, left, right_topic, infos, size, colours) for i, t in enumerate(stamps())), []))
    right[name] = dict(path=name, pairs=N, stamps=stamps(), **(dict(fx=FX, cx=CX, baseline=BASE) | told))


def truth_file(path, frame='tum'):
    x, y, z, w = LOOKS_EAST_XYZW
    if frame == 'tum':
        put(path, ''.join(f'{t // 10**9}.{t % 10**9:09d} {i} 0 0 {x} {y} {z} {w}\n' for i, t in enumerate(stamps())))
    else:
        put(path, '#sec,nsec,x,y,z,qx,qy,qz,qw\n' + ''.join(f'{t // 10**9},{t % 10**9},{i},0,0,{x},{y},{z},{w}\n' for i, t in enumerate(stamps())))
    return dict(truth=[[i, 0, 0] for i in range(N)], forward=[1, 0, 0])


citrusfarm()
single_bag('rosario-v1', 'sequence01.bag', '/stereo/left/image_raw', '/stereo/right/image_raw', ('/stereo/left/camera_info', '/stereo/right/camera_info'), **truth_file(OUT / 'rosario-v1' / 'sequence01_gt.txt'))
single_bag('rosario-v2', '2023-12-22-13-14-16.compressed.bag', '/realsense/infra1/image_rect_raw', '/realsense/infra2/image_rect_raw', size=(1280, 720), fx=648.8624169653789, cx=645.0113372802734, baseline=32.599425851220396 / 648.8624169653789, fixes=1)
bag(OUT / 'rosario-v2' / '2023-12-22-13-14-16_ppk_gnss.bag', [fix('/reach_1/ppk/fix', T0, -32.9, -60.7)])
single_bag('botanicgarden', '1018_00.bag', '/dalsa_rgb/left/image_raw', '/dalsa_rgb/right/image_raw', size=(960, 600), fx=None, cx=None, baseline=0.25373719, **truth_file(OUT / 'botanicgarden' / '1018_00_GT_output.txt'))
single_bag('fieldsafe', '2016-10-25-11-09-42.bag', '/Multisense/left/image_rect_color', '/Multisense/right/image_rect', ('/Multisense/left/camera_info', '/Multisense/right/camera_info'), colours=(True, False))
single_bag('newer-college', 'rooster_2020-03-10-10-36-30_0.bag', '/camera/infra1/image_rect_raw', '/camera/infra2/image_rect_raw', ('/camera/infra1/camera_info', '/camera/infra2/camera_info'), **truth_file(OUT / 'newer-college' / 'ground_truth' / 'registered_poses.csv', 'sec,nsec'))
