//! Lines of numbers in files of poses, as people have them: comments, a line that names the columns, blanks, tabs or
//! commas between the numbers, any line ends, a byte order mark.

/// The lines of a file of poses that are neither blank nor comments nor a first line that names TUM's columns, each
/// with its number from 1.
pub fn pose_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let content = |(_, content): &(usize, &str)| !content.is_empty() && !is_comment(content);
    let mut lines = numbered(text).filter(content).peekable();
    lines.next_if(|(_, first)| column_order(first) == Some(ColumnOrder::Tum));
    lines
}

/// The first line before the poses, a comment or not, that names the columns of a file in an order that is not TUM's:
/// its number from 1 and its text.
pub(crate) fn other_columns(text: &str) -> Option<(usize, &str)> {
    let mut before = numbered(text).take_while(|(_, content)| finite_numbers(content).is_none_or(|n| n.is_empty()));
    before.find(|(_, content)| column_order(content) == Some(ColumnOrder::Other))
}

/// Every line with its number from 1, without blanks around it.
fn numbered(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    text.lines().enumerate().map(|(index, line)| (index + 1, line.trim()))
}

fn is_comment(line: &str) -> bool {
    line.starts_with(['#', '%'])
}

/// The words of a line: between commas if there are any, else between semicolons, else between blanks. Between commas a
/// missing value is an empty word, so that those behind it do not move up.
pub fn words(line: &str) -> Vec<&str> {
    match [',', ';'].into_iter().find(|mark| line.contains(*mark)) {
        Some(mark) => line.strip_suffix(mark).unwrap_or(line).split(mark).map(str::trim).collect(),
        None => line.split_whitespace().collect(),
    }
}

/// The numbers of a line; `None` where a word is no finite number.
pub fn finite_numbers(line: &str) -> Option<Vec<f64>> {
    words(line).into_iter().map(|word| word.parse().ok().filter(|value: &f64| value.is_finite())).collect()
}

/// What an error says of a line that is no pose: how many numbers it has, or how it begins.
pub fn describe_line(line: &str) -> String {
    match finite_numbers(line) {
        Some(numbers) => format!("{} numbers", numbers.len()),
        None => format!("{:?}", line.chars().take(60).collect::<String>()),
    }
}

/// In which order a line says that the columns stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ColumnOrder {
    /// Position x y z, then quaternion x y z w; time before all, where it is named.
    Tum,
    /// Any other that has a quaternion.
    Other,
}

/// The order that a line of words names; `None` where it does not name the four columns of a quaternion.
fn column_order(line: &str) -> Option<ColumnOrder> {
    let names = words(line.trim_start_matches(['#', '%', ' ', '\t'])).into_iter().map(column_of);
    let columns: Vec<Column> = names.filter(|column| *column != Column::Nameless).collect();
    let places = |wanted: fn(char) -> Column| ['x', 'y', 'z', 'w'].map(|axis| place_of(&columns, wanted(axis)));
    let [Some(qx), Some(qy), Some(qz), Some(qw)] = places(Column::Quaternion) else { return None };
    let is_position = match places(Column::Position) {
        [Some(x), Some(y), Some(z), _] => (y, z) == (x + 1, x + 2) && z < qx,
        _ => true,
    };
    let is_first = place_of(&columns, Column::Time).is_none_or(|place| place == 0);
    let is_tum = is_first && is_position && (qy, qz, qw) == (qx + 1, qx + 2, qx + 3);
    Some(if is_tum { ColumnOrder::Tum } else { ColumnOrder::Other })
}

fn place_of(columns: &[Column], wanted: Column) -> Option<usize> {
    columns.iter().position(|column| *column == wanted)
}

/// What a column's name says that it holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Column {
    Time,
    Position(char),
    Quaternion(char),
    Other,
    /// A unit in brackets, or nothing.
    Nameless,
}

/// Reads a name such as `tx`, `q_RS_w []`, `p_RS_R_x [m]`, `pose.orientation.x`.
fn column_of(name: &str) -> Column {
    let name = name.split(['[', '(']).next().unwrap_or_default().trim().to_lowercase();
    let Some(axis) = name.chars().last() else { return Column::Nameless };
    if name == "t" || name.ends_with("time") || name.ends_with("stamp") {
        return Column::Time;
    }
    if !"xyzw".contains(axis) || name.chars().any(char::is_whitespace) {
        return Column::Other;
    }
    let stem = name[..name.len() - 1].trim_end_matches(['_', '.', '-']);
    let has = |parts: &[&str]| parts.iter().any(|part| stem.contains(*part));
    if axis == 'w' || stem.starts_with('q') || has(&["quat", "orient", "rot"]) {
        Column::Quaternion(axis)
    } else if ["", "t", "p"].contains(&stem)
        || ["p_", "t_"].iter().any(|start| stem.starts_with(start))
        || has(&["pos", "trans"])
    {
        Column::Position(axis)
    } else {
        Column::Other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headers_are_told_by_their_names() {
        let tum = ["timestamp tx ty tz qx qy qz qw", "# timestamp tx ty tz qx qy qz qw", "%time,x,y,z,q_x,q_y,q_z,q_w"];
        let more =
            ["stamp [s], p_x [m], p_y [m], p_z [m], q_x [], q_y [], q_z [], q_w []", "t east north up qx qy qz qw"];
        let prose = [
            "# timestamp tx ty tz qx qy qz qw (world from left camera, camera x right)",
            "# timestamp, tx, ty, tz, qx, qy, qz, qw, in metres",
            "# tx ty tz qx qy qz qw",
        ];
        for line in tum.iter().chain(&more).chain(&prose[1..]) {
            assert_eq!(column_order(line), Some(ColumnOrder::Tum), "{line}");
        }
        let euroc = "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], v_RS_R_x [m s^-1]";
        for line in [euroc, "time,x,y,z,qw,qx,qy,qz", "time tx tz ty qx qy qz qw", "x y z qx qy qz qw time"] {
            assert_eq!(column_order(line), Some(ColumnOrder::Other), "{line}");
        }
        for line in
            ["# ground truth trajectory", "# file: 'rgbd_dataset_freiburg1_xyz.bag'", "1 2 3 4 5 6 7 8", "", "#"]
        {
            assert_eq!(column_order(line), None, "{line}");
        }
    }

    #[test]
    fn a_missing_value_moves_nothing_up() {
        assert_eq!(words("1, 2,3,"), ["1", "2", "3"]);
        assert_eq!(finite_numbers("1,,3"), None);
        assert_eq!(finite_numbers("1\t2   3\r"), Some(vec![1.0, 2.0, 3.0]));
        assert_eq!(finite_numbers("1,5;2,5"), None);
    }
}
