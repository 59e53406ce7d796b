//! What is simulated: a traversal of a route of a site, at a time, in some weather, as data and in words. Nothing here
//! knows how it is rendered or recorded.

pub mod bad_name;
pub mod check;
pub mod date;
mod description;
pub mod request;
pub mod site;
pub mod weather;

pub use bad_name::BadName;
pub use check::BadTraversal;
pub use date::Date;
pub use request::Traversal;
pub use site::Site;
pub use weather::Weather;

#[cfg(test)]
mod tests {
    use super::{Date, Site, Weather};

    #[test]
    fn names_read_back_and_others_are_refused() {
        for site in Site::ALL {
            assert_eq!(site.to_string().parse(), Ok(site));
        }
        for weather in Weather::ALL {
            assert_eq!(weather.to_string().parse(), Ok(weather));
        }
        let error = "Old Zoo".parse::<Site>().expect_err("no such site").to_string();
        assert_eq!(error, "'Old Zoo' is no site: expected backsburg, lindenhof or old-zoo");
        for text in ["2026-02-29", "2026-1-15", "2026-13-01", "15-01-2026", "2026-01-15-1", ""] {
            assert!(text.parse::<Date>().is_err(), "{text}");
        }
    }
}
