"""Lays real frames out as other people's datasets have them, by their documentation, with the standard library only:
real.py DATA OUT. Prints for each the true length in metres, of positions that were measured, as JSON."""
import json, math, shutil, sys
from pathlib import Path

DATA, OUT = Path(sys.argv[1]), Path(sys.argv[2])
right = {}


def put(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def copy(source, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(source, path)


def length(points):
    return sum(math.dist(a, b) for a, b in zip(points, points[1:]))


def odometry(frames):
    """KITTI odometry: sequences/00, the poses in a folder of their own two levels above."""
    source, d = DATA / 'kitti_odo_seqA', OUT / 'kitti' / 'sequences' / '00'
    for i in range(frames):
        copy(source / 'image_l' / f'{i:06d}.jpg', d / 'image_0' / f'{i:06d}.jpg')
        copy(source / 'image_r' / f'{i:06d}.jpg', d / 'image_1' / f'{i:06d}.jpg')
    put(d / 'times.txt', ''.join(f'{0.1037 * i:e}\n' for i in range(frames)))
    left, right_line = [line for line in (source / 'calib.txt').read_text().splitlines() if line.strip()][:2]
    put(d / 'calib.txt', f'P0: {left}\nP1: {right_line}\nP2: {left}\nP3: {right_line}\n')
    poses = [line for line in (source / 'poses.txt').read_text().splitlines() if line.strip()][:frames]
    put(OUT / 'kitti' / 'poses' / '00.txt', '\n'.join(poses) + '\n')
    points = [[float(line.split()[k]) for k in (3, 7, 11)] for line in poses]
    right['kitti-odometry'] = dict(path='kitti/sequences/00', pairs=frames, length=length(points), points=points)


def raw(first, last):
    """KITTI raw, as the cameras took it: each camera's own stamps, OXTS at 100 Hz with gaps."""
    source, day = DATA / 'kitti_raw_drive_A', OUT / '2011_09_26'
    d = day / '2011_09_26_drive_0001_extract'
    copy(source / 'calib_cam_to_cam.txt', day / 'calib_cam_to_cam.txt')
    rows = [line.split(',') for line in (source / 'timestamps.csv').read_text().splitlines()[1:]]
    for cam, column in (('image_00', 1), ('image_01', 2)):
        put(d / cam / 'timestamps.txt', ''.join(row[column] + '\n' for row in rows))
        for row in rows[first:last]:
            if row[column + 2] == '1':
                copy(source / cam / f'{int(row[0]):06d}.jpg', d / cam / 'data' / f'{int(row[0]):010d}.jpg')
    # 10 ms apart from frame 0, 14:05:35.500923136, as the source tells.
    stamp = lambda k: (35_500_923_136 + 10_000_000 * k)
    line = lambda ns: f'2011-09-26 14:{5 + ns // 60_000_000_000:02d}:{ns % 60_000_000_000 // 10**9:02d}.{ns % 10**9:09d}\n'
    put(d / 'oxts' / 'timestamps.txt', ''.join(line(stamp(k)) for k in range(2500)))
    for file in (source / 'oxts').iterdir():
        copy(file, d / 'oxts' / 'data' / file.name)
    track = [[float(word) for word in line.split(',')] for line in (source / 'gps_track.csv').read_text().splitlines()[1:]]
    def at(seconds):
        after = next(k for k, row in enumerate(track) if row[0] * 0.01 >= seconds)
        a, b = track[max(after - 1, 0)], track[after]
        share = (seconds - a[0] * 0.01) / max((b[0] - a[0]) * 0.01, 1e-9)
        return [a[k] + share * (b[k] - a[k]) for k in (2, 3, 4)]
    seconds = lambda text: 60 * int(text[14:16]) + float(text[17:])
    zero = seconds(rows[0][1])
    # The source lacks the left image 23 and the right one 22.
    points = [at(seconds(row[1]) - zero) for row in rows[first:last] if row[3] == row[4] == '1']
    right['kitti-raw'] = dict(path='2011_09_26/2011_09_26_drive_0001_extract', pairs=len(points), length=length(points))


def stromovka(frames):
    """A plain folder, and the same places as a set for place recognition, 5 m apart to the north-east."""
    step = 5 / math.sqrt(2)
    for i in range(frames):
        source = DATA / 'stromovka_2season_traverse' / 'autumn' / f'{i:04d}.jpg'
        copy(source, OUT / 'autumn' / source.name)
        east, north = 457_000 + step * i, 5_550_000 + step * i
        copy(source, OUT / 'places' / f'@{east:010.2f}@{north:010.2f}@33@U@@@{i}@@@@@@@@.jpg')
    right['mono'] = dict(path='autumn', pairs=frames, length=5.0 * (frames - 1))
    right['vpr'] = dict(path='places', pairs=frames, length=5.0 * (frames - 1))


odometry(24)
raw(10, 60)
stromovka(12)
print(json.dumps(right))
