#include "apps/tactus/run_record.h"

#include <filesystem>

#include "apps/tactus/run_folder.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {

using runtime::CsvTable;

CsvTable readIfThere(const std::string& path) {
  return std::filesystem::exists(path) ? CsvTable::read(path) : CsvTable();
}

RunRecord readRunRecord(const std::string& folder) {
  RunRecord record;
  record.folder = folder;
  record.file = folder + "/run.json";
  record.json = readJson(record.file);
  if (record.run().at("format").text("") != run_format)
    throw runtime::FileError(record.file, std::string("is not of the format ") + run_format);
  record.cut_off = record.run().at("status").text() == status_running;
  const auto read = [&](const std::string& name, bool required) {
    const std::string path = folder + "/" + name;
    CsvTable table = required ? CsvTable::read(path) : readIfThere(path);
    if (table.endsWithinLine()) record.warnings.push_back(path + " ends within a line, which is left out");
    return table;
  };
  record.log = read("log.csv", !record.cut_off);
  record.touched = read("touched_points.csv", !record.cut_off);
  record.frames = read("replay.csv", false);
  record.contacts = read("replay_contacts.csv", false);
  return record;
}

}  // namespace tactus::app
