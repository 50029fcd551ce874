//! `partwright schema`.

use super::args::post::Schema;
use crate::post;

/// The schema's text.
pub fn text(of: Schema) -> String {
    match of {
        Schema::Post => serde_json::to_string_pretty(&post::json_schema()).unwrap_or_default() + "\n",
        Schema::Report => include_str!("../../docs/schema/report.schema.json").to_owned(),
        Schema::Diagnostics => include_str!("../../docs/schema/diagnostics.schema.json").to_owned(),
    }
}
