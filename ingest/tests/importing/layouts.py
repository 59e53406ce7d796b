"""Writes a small tree for each layout that furrow imports, from the layouts' public documentation, with the standard library
only. Prints what is right of each as JSON: pairs, stamps in nanoseconds, fx, cx, baseline, true positions and headings."""
import json, math, struct, sys, zlib
from pathlib import Path

OUT = Path(sys.argv[1])
W, H, N = 64, 48, 5
FX, CX, CY, BASE = 80.0, 31.5, 23.5, 0.25
T0 = 1_700_000_000_000_000_000
DT = 100_000_000
right = {}


def png(pixel, w=W, h=H, channels=1):
    """A PNG whose pixel (x, y) is pixel(x, y): a number, or three."""
    rows = b''.join(b'\0' + b''.join(bytes(pixel(x, y)) if channels == 3 else bytes([pixel(x, y)]) for x in range(w)) for y in range(h))
    chunk = lambda kind, data: struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    head = struct.pack('>IIBBBBB', w, h, 8, 2 if channels == 3 else 0, 0, 0, 0)
    return b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', head) + chunk(b'IDAT', zlib.compress(rows)) + chunk(b'IEND', b'')


def grey(side, i, w=W, h=H):
    return png(lambda x, y: (7 * x + 13 * y + 31 * i + (90 if side == 'right' else 0)) % 251, w, h)


def put(path, data):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data if isinstance(data, bytes) else data.encode())


def stamps(step=DT, start=T0):
    return [start + i * step for i in range(N)]


def forward(quaternion_xyzw):
    x, y, z, w = quaternion_xyzw
    return [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)]


# A camera that looks along the world's x axis, y to the left, z up: its columns are the images of x right, y down, z ahead.
LOOKS_EAST_XYZW = (-0.5, 0.5, -0.5, 0.5)


def euroc():
    """mav0: data.csv with CRLF, sensor.yaml with T_BS, poses of the body with w first."""
    d = OUT / 'euroc' / 'mav0'
    for cam, side, at in (('cam0', 'left', 0.5), ('cam1', 'right', 0.5 + BASE)):
        listed = stamps() + ([T0 + N * DT] if cam == 'cam1' else [])  # an image of cam1 that was lost
        for i, t in enumerate(stamps()):
            put(d / cam / 'data' / f'{t}.png', grey(side, i))
        put(d / cam / 'data' / f'{T0 - DT}.png', grey(side, 9))  # not listed
        put(d / cam / 'data.csv', '#timestamp [ns],filename\r\n' + ''.join(f'{t},{t}.png\r\n' for t in listed))
        put(d / cam / 'sensor.yaml', f'sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: [1.0, 0.0, 0.0, {at}, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]\n'
            f'rate_hz: 20\nresolution: [{W}, {H}]\ncamera_model: pinhole\nintrinsics: [{FX}, {FX}, {CX}, {CY}] #fu, fv, cu, cv\ndistortion_model: radial-tangential\ndistortion_coefficients: [0.0, 0.0, 0.0, 0.0]\n')
    x, y, z, w = LOOKS_EAST_XYZW
    header = '#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], v_RS_R_x [m s^-1]\n'
    put(d / 'state_groundtruth_estimate0' / 'data.csv', header + ''.join(f'{t},{2.0 * i},3.0,1.0,{w},{x},{y},{z},0.0\n' for i, t in enumerate(stamps())))
    put(d / 'imu0' / 'data.csv', '#timestamp [ns],w_RS_S_x [rad s^-1],w_y,w_z,a_RS_S_x [m s^-2],a_y,a_z\n' + ''.join(f'{t},0.1,0.2,0.3,9.8,0.5,0.6\n' for t in stamps()))
    # The camera's x axis, 0.5 m to the right on the body, is the world's -y.
    right['euroc'] = dict(path='euroc', pairs=N, stamps=stamps(), fx=FX, cx=CX, baseline=BASE, truth=[[2.0 * i, 2.5, 1.0] for i in range(N)], forward=[1, 0, 0], imu=N)


def tum_vi():
    """EuRoC's folders with equidistant lenses, in Kalibr's camchain; poses of the IMU."""
    d = OUT / 'tum-vi'
    lens = 'camera_model: pinhole\n  distortion_coeffs: [0.01, -0.002, 0.001, -0.0003]\n  distortion_model: equidistant\n'
    chain = ''
    for cam, side in (('cam0', 'left'), ('cam1', 'right')):
        for i, t in enumerate(stamps()):
            put(d / 'mav0' / cam / 'data' / f'{t}.png', grey(side, i))
        put(d / 'mav0' / cam / 'data.csv', '#timestamp [ns],filename\n' + ''.join(f'{t},{t}.png\n' for t in stamps()))
        at = 0.0 if cam == 'cam0' else -BASE
        rows = lambda tx: ''.join(f'  - {row}\n' for row in ([1.0, 0.0, 0.0, tx], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]))
        step = f'  T_cn_cnm1:\n{rows(-BASE)}' if cam == 'cam1' else ''
        chain += f'{cam}:\n  T_cam_imu:\n{rows(at - 0.5)}{step}  {lens}  intrinsics: [{FX}, {FX}, {CX}, {CY}]\n  resolution: [{W}, {H}]\n  rostopic: /{cam}/image_raw\n'
    put(d / 'dso' / 'camchain.yaml', chain)
    x, y, z, w = LOOKS_EAST_XYZW
    put(d / 'mav0' / 'mocap0' / 'data.csv', '#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []\n' + ''.join(f'{t},{i * 1.0},3.0,1.0,{w},{x},{y},{z}\n' for i, t in enumerate(stamps())))
    right['tum-vi'] = dict(path='tum-vi', pairs=N, stamps=stamps(), baseline=BASE, truth=[[1.0 * i, 2.5, 1.0] for i in range(N)], forward=[1, 0, 0])


def kitti_odometry():
    """sequences/00 with calib.txt and times.txt; poses/00.txt in the first camera's frame."""
    d = OUT / 'kitti' / 'sequences' / '00'
    times = [0.0, 0.1036, 0.2072, 0.3108, 0.4145]
    for i in range(N):
        put(d / 'image_0' / f'{i:06d}.png', grey('left', i)), put(d / 'image_1' / f'{i:06d}.png', grey('right', i))
    p = lambda tx: f'{FX:e} 0 {CX:e} {tx:e} 0 {FX:e} {CY:e} 0 0 0 1 0'
    put(d / 'calib.txt', ''.join(f'P{c}: {p(0 if c % 2 == 0 else -FX * BASE)}\n' for c in range(4)))
    put(d / 'times.txt', ''.join(f'{t:.6e}\n' for t in times))
    put(OUT / 'kitti' / 'poses' / '00.txt', ''.join(f'1 0 0 {0.1 * i} 0 1 0 {-0.2 * i} 0 0 1 {1.5 * i}\n' for i in range(N)))
    right['kitti-odometry'] = dict(path='kitti/sequences/00', pairs=N, stamps=[round(t * 1e9) for t in times], fx=FX, cx=CX, baseline=BASE,
                                   truth=[[0.1 * i, 1.5 * i, 0.2 * i] for i in range(N)], forward=[0, 1, 0])


def kitti_raw(name, size, rectified):
    """A drive below its day: timestamps with nine digits, calib_cam_to_cam.txt above, oxts with latitude and yaw."""
    day = OUT / name
    d = day / f'drive_{name}'
    line = lambda t: f'2011-09-26 13:02:{25 + t // 10**9:02d}.{t % 10**9:09d}\n'
    offsets = [i * DT + 964_389_445 for i in range(N)]
    for cam, side, lag in (('image_00', 'left', 0), ('image_01', 'right', 12_288)):
        for i in range(N):
            put(d / cam / 'data' / f'{i:010d}.png', grey(side, i, *size))
        put(d / cam / 'timestamps.txt', ''.join(line(t + lag) for t in offsets))
    text = 'calib_time: 09-Jan-2012 13:57:47\ncorner_dist: 9.950000e-02\n'
    for c, tx in ((0, 0), (1, -FX * BASE)):
        text += f'S_{c:02d}: {W:e} {H:e}\nK_{c:02d}: {FX} 0 {CX} 0 {FX} {CY} 0 0 1\nD_{c:02d}: -0.01 0.001 0 0 0\nR_{c:02d}: 1 0 0 0 1 0 0 0 1\nT_{c:02d}: {tx / FX} 0 0\n'
        text += f'S_rect_{c:02d}: {W - 4:e} {H - 6:e}\nR_rect_{c:02d}: 1 0 0 0 1 0 0 0 1\nP_rect_{c:02d}: {FX - 2} 0 {CX - 2} {tx / FX * (FX - 2)} 0 {FX - 2} {CY - 3} 0 0 0 1 0\n'
    put(day / 'calib_cam_to_cam.txt', text)
    # The velodyne looks along x; the camera z forward, x right. The IMU sits 1 m behind the velodyne.
    put(day / 'calib_velo_to_cam.txt', 'R: 0 -1 0 0 0 -1 1 0 0\nT: 0 0 0\ndelta_f: 0 0\n')
    put(day / 'calib_imu_to_velo.txt', 'R: 1 0 0 0 1 0 0 0 1\nT: -1 0 0\n')
    for i in range(N):
        put(d / 'oxts' / 'data' / f'{i:010d}.txt', f'{49.0 + i * 1e-5:.12f} 8.5 112.5 0.01 0.02 {math.pi / 2} ' + ' '.join(str(k) for k in range(7, 31)) + '\n')
    put(d / 'oxts' / 'timestamps.txt', ''.join(line(t) for t in offsets))
    start = 1_317_042_145 * 10**9  # date -u -d '2011-09-26 13:02:25' +%s
    right[name] = dict(profile='kitti-raw', path=f'{name}/drive_{name}', pairs=N, stamps=[start + t for t in offsets], fx=FX - 2, cx=CX - 2, baseline=BASE, imu=N, fixes=N,
                       size=[W - 4, H - 6], up=112.5, step=0.9996 * 1.1121, forward=[0, 1, 0])


def tum_rgbd():
    d = OUT / 'tum-rgbd'
    seconds = [f'130503110{2 + i // 10}.{175304 + 33000 * i:06d}' for i in range(N)]
    for i, s in enumerate(seconds):
        put(d / 'rgb' / f'{s}.png', png(lambda x, y: ((x + i) % 256, y % 256, 40), 640, 480, 3))
    put(d / 'rgb.txt', "# color images\n# file: 'rgbd_dataset_freiburg1_xyz.bag'\n# timestamp filename\n" + ''.join(f'{s} rgb/{s}.png\n' for s in seconds))
    ns = [int(s.split('.')[0]) * 10**9 + int(s.split('.')[1]) * 1000 for s in seconds]
    # At 100 Hz, between the images; 0.5 m/s along x.
    truth = [ns[0] - 5_000_000 + 10_000_000 * k for k in range(16)]
    put(d / 'groundtruth.txt', '# ground truth trajectory\n# timestamp tx ty tz qx qy qz qw\n' + ''.join(f'{t // 10**9}.{t % 10**9 // 100000:04d} {0.5 * (t - ns[0]) / 1e9:.6f} 1.0 1.5 -0.5 0.5 -0.5 0.5\n' for t in truth))
    right['tum-rgbd'] = dict(path='tum-rgbd', single=True, pairs=N, stamps=ns, fx=525.0, cx=319.5, length=0.5 * 0.132, forward=[1, 0, 0])


def robotcar():
    """GBRG mosaics named in microseconds, and the tables of the camera models: each shows what lies three pixels on."""
    d = OUT / 'robotcar'
    us = [1_418_381_798_086_398 + 62_500 * i for i in range(N)]
    colour = lambda x, y: (3 * x, 100, 50)
    def mosaic(x, y):  # G B / R G
        r, g, b = colour(x, y)
        return g if (x + y) % 2 == 0 else (b if y % 2 == 0 else r)
    for side in ('left', 'right'):
        for t in us:
            put(d / 'stereo' / side / f'{t}.png', png(mosaic))
        columns = [float(x + 3) for _ in range(H) for x in range(W)]
        rows = [float(y) for y in range(H) for _ in range(W)]
        put(OUT / 'robotcar' / 'models' / f'stereo_wide_{side}_distortion_lut.bin', struct.pack(f'<{2 * W * H}d', *columns, *rows))
        put(OUT / 'robotcar' / 'models' / f'stereo_wide_{side}.txt', f'{FX} {FX} {CX} {CY}\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n')
    put(d / 'stereo.timestamps', ''.join(f'{t} 1\n' for t in us))
    header = 'timestamp,ins_status,latitude,longitude,altitude,northing,easting,down,utm_zone,velocity_north,velocity_east,velocity_down,roll,pitch,yaw\n'
    row = lambda i, t: f'{t},INS_SOLUTION_GOOD,51.76,-1.26,112.5,{5735000.0 + i},{620000.0 + 2 * i},-112.5,30U,1,2,0,0.0,0.0,{math.atan2(2, 1)}\n'
    put(d / 'gps' / 'ins.csv', header + ''.join(row(i, t) for i, t in enumerate(us)))
    put(d / 'gps' / 'gps.csv', 'timestamp,num_satellites,latitude,longitude,altitude,latitude_sigma,longitude_sigma,altitude_sigma,northing,easting,down,utm_zone\n' + ''.join(f'{t},9,51.76,-1.26,112.5,1,1,1,5735000,620000,-112.5,30U\n' for t in us))
    right['robotcar'] = dict(path='robotcar', pairs=N, stamps=[1000 * t for t in us], fx=FX, cx=CX, baseline=0.239983, fixes=N,
                             truth=[[620000.0 + 2 * i, 5735000.0 + i, 112.5] for i in range(N)], forward=[2 / math.sqrt(5), 1 / math.sqrt(5), 0])


def rover():
    d = OUT / 'rover'
    for i, t in enumerate(stamps()):
        name = f'{t // 10**9}.{t % 10**9 // 1000:06d}.png'
        put(d / 't265' / 'cam_left' / name, grey('left', i)), put(d / 't265' / 'cam_right' / name, grey('right', i))
    put(d / 'ground_truth.txt', ''.join(f'{t // 10**9}.{t % 10**9 // 1000:06d} {i} 0 0 -0.5 0.5 -0.5 0.5\n' for i, t in enumerate(stamps())))
    yaml = lambda tx: f'image_width: {W}\nimage_height: {H}\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: [{FX}, 0.0, {CX}, 0.0, {FX}, {CY}, 0.0, 0.0, 1.0]\ndistortion_model: plumb_bob\ndistortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [0.0, 0.0, 0.0, 0.0, 0.0]\nrectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]\nprojection_matrix:\n  rows: 3\n  cols: 4\n  data: [{FX}, 0.0, {CX}, {tx}, 0.0, {FX}, {CY}, 0.0, 0.0, 0.0, 1.0, 0.0]\n'
    put(OUT / 'left.yaml', yaml(0.0)), put(OUT / 'right.yaml', yaml(-FX * BASE))
    right['rover'] = dict(path='rover', calibration=['left.yaml', 'right.yaml'], pairs=N, stamps=stamps(), fx=FX, cx=CX, baseline=BASE, truth=[[i, 0, 0] for i in range(N)], forward=[1, 0, 0])


def mono_and_vpr():
    for i in range(N):
        put(OUT / 'mono' / f'frame{i + 8}.png', grey('left', i))
        put(OUT / 'vpr' / f'@{551102.0 + 3 * i:010.2f}@{4183141.25 + 4 * i:010.2f}@10@S@037.79456@-122.41978@{i}@@@@@@@@.jpg', grey('left', i))
    right['mono'] = dict(path='mono', single=True, spacing=2.0, pairs=N, stamps=[i * DT for i in range(N)], length=8.0)
    right['vpr'] = dict(path='vpr', single=True, pairs=N, stamps=[i * 10**9 for i in range(N)], length=20.0, truth=[[551102.0 + 3 * i, 4183141.25 + 4 * i, 0] for i in range(N)], forward=[0.6, 0.8, 0])


for write in (euroc, tum_vi, kitti_odometry, tum_rgbd, robotcar, rover, mono_and_vpr):
    write()
kitti_raw('sync', (W - 4, H - 6), True)
kitti_raw('extract', (W, H), False)
exec(compile(Path(sys.argv[2]).read_text(), 'bags.py', 'exec'))
print(json.dumps(right))
