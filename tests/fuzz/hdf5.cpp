// Demonstrations in types and sizes that the input says, such as {"utterance": "Go.", "instances": "[[]]",
// "actions": ["f4", [1, 12]], "obs/rgb": ["u1", [1, 4, 8, 3]], "obs/ids": ["u1", [1, 4, 8]]}. HDF5's own library writes
// the file: damaged bytes make it fail in ways of its own, which is why a cached file's checksum is verified first.
#include <hdf5.h>

#include <lgabench/cell/hdf5.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/json.hpp>

#include "fuzz.hpp"

namespace {

using namespace lgabench;

class Id {
 public:
  Id(hid_t id) : id_(id) {}
  ~Id() {
    if (id_ >= 0) H5Idec_ref(id_);
  }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
};

// A number stands for an integer of so many bytes. With more, as a negative one is, the library's own sums overflow.
hid_t type_of(const Json& said) {
  if (said == "f4") return H5Tcopy(H5T_IEEE_F32LE);
  if (said == "f8") return H5Tcopy(H5T_IEEE_F64LE);
  const hid_t type = H5Tcopy(said == "text" ? H5T_C_S1 : H5T_STD_U8LE);
  if (said.is_number_unsigned() && said <= 1 << 30) H5Tset_size(type, said.get<std::size_t>());
  return type;
}

void write_text(hid_t group, const char* name, const std::string& text) {
  const hsize_t size = text.size();
  const Id space(H5Screate_simple(1, &size, nullptr));
  const Id set(H5Dcreate2(group, name, H5T_STD_U8LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Dwrite(set, H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data());
}

// Never written, a dataset of any size costs nothing, and is read as zeros.
void make_dataset(hid_t group, const char* name, const Json& said) {
  if (!said.is_array() || said.size() != 2 || !said[1].is_array() || said[1].size() > H5S_MAX_RANK) return;
  std::vector<hsize_t> sizes;
  for (const Json& size : said[1]) sizes.push_back(size.is_number_integer() ? size.get<hsize_t>() : 1);
  const Id type(type_of(said[0])), space(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr));
  const Id set(H5Dcreate2(group, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
}

void write_utterance(hid_t group, const Json& said) {
  const std::string text = said.is_string() ? said.get<std::string>() : "";
  const Id type(said.is_string() ? H5Tcopy(H5T_C_S1) : type_of(said)), space(H5Screate(H5S_SCALAR));
  if (said.is_string()) H5Tset_size(type, text.size() + 1);
  const Id attribute(H5Acreate2(group, "utterance", type, space, H5P_DEFAULT, H5P_DEFAULT));
  if (said.is_string()) H5Awrite(attribute, type, text.c_str());
}

std::string file_of(const Json& demonstration) {
  const Id access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_fapl_core(access, 1 << 16, false);
  const Id file(H5Fcreate("demonstrations", H5F_ACC_TRUNC, H5P_DEFAULT, access));
  {
    const Id data(H5Gcreate2(file, "data", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    const Id group(H5Gcreate2(data, "demo_0", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    const Id obs(H5Gcreate2(group, "obs", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
    for (const auto& [name, said] : demonstration.items())
      if (name == "utterance")
        write_utterance(group, said);
      else if (said.is_string())
        write_text(group, name.c_str(), said.get<std::string>());
      else
        make_dataset(group, name.c_str(), said);
  }
  H5Fflush(file, H5F_SCOPE_GLOBAL);
  std::string bytes(static_cast<std::size_t>(std::max<ssize_t>(H5Fget_file_image(file, nullptr, 0), 0)), '\0');
  H5Fget_file_image(file, bytes.data(), bytes.size());
  return bytes;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Json demonstration = json_or_null(fuzz::text_of(data, size));
  if (!demonstration.is_object()) return 0;
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  try {
    read_demonstrations(file_of(demonstration), "fuzzed.hdf5");
  } catch (const InputError&) {
  }
  return 0;
}
