// Names of labels as FreeSurfer, ITK-SNAP and BIDS list them, and names of files made of them.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "isoweave/label_names.hpp"

namespace isoweave::testing::volume_label_names_test {
namespace {

std::string text_of(const std::vector<LabelName>& names) {
  std::string text;
  for (const LabelName& name : names) {
    text += name.label.text() + "=" + name.name;
    if (name.color) {
      for (const double part : *name.color) text += " " + std::to_string(static_cast<int>(255 * part + 0.5));
    }
    text += "|";
  }
  return text;
}

class LabelNames : public ::testing::Test {
 protected:
  std::string read(const std::string& content) {
    files::write_bytes(folder_ / "names.txt", content);
    return text_of(read_label_names(folder_ / "names.txt"));
  }

  std::string refusal(const std::string& content) {
    try {
      return read(content);
    } catch (const BadInput& error) {
      return error.what();
    }
  }

  void expect_refused(const std::string& content, const std::string& says) {
    const std::string message = refusal(content);
    EXPECT_NE(message.find(says), std::string::npos) << message;
    EXPECT_NE(message.find("names.txt: expected "), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }

  files::Folder folder_;
};

TEST_F(LabelNames, OfFreeSurfer) {
  EXPECT_EQ(read("#$Id: FreeSurferColorLUT.txt\n\n#No. Label Name:                            R   G   B   A\n\n"
                 "0   Unknown                                 0   0   0   0\n"
                 "17  Left-Hippocampus                        220 216 20  0\r\n"
                 "  1001\tctx-lh-bankssts 25 100 40 0\n"
                 "14175 wm_rh_S_temporal_transverse 221 60 60 0"),
            "0=Unknown 0 0 0|17=Left-Hippocampus 220 216 20|1001=ctx-lh-bankssts 25 100 40|"
            "14175=wm_rh_S_temporal_transverse 221 60 60|");
}

// As 3D Slicer, MRtrix and others shorten it; a name may have blanks in it, and numbers.
TEST_F(LabelNames, InLinesOfFewerColumns) {
  EXPECT_EQ(
      read("1 liver 10 20 30\n2 Area 17 \n3 left lung 1 2 3 255\n4 V1 300 2 3 4\n-5 below\n7112614941 far 0 0 0 0\n"),
      "1=liver 10 20 30|2=Area 17|3=left lung 1 2 3|4=V1 300 2 3 4|-5=below|7112614941=far 0 0 0|");
}

TEST_F(LabelNames, OfItkSnap) {
  EXPECT_EQ(read("################\n# ITK-SnAP Label Description File\n"
                 "    0     0    0    0        0  0  0    \"Clear Label\"\n"
                 "    1   255    0    0        1  1  1    \"Label 1\"\n"
                 "   12     0  151  221     0.35  1  1    \"He said \"so\"\"\n"),
            "0=Clear Label 0 0 0|1=Label 1 255 0 0|12=He said \"so\" 0 151 221|");
}

TEST_F(LabelNames, OfBids) {
  EXPECT_EQ(read("index\tname\tmapping\n0\tBackground\t0\n1\tGray Matter\t1\n"), "0=Background|1=Gray Matter|");
  EXPECT_EQ(read("\xef\xbb\xbfName\tIndex\tColor\r\nVentral nucleus, 7\t12\t#ff00fe\r\nn/a\t13\tn/a\r\n"),
            "12=Ventral nucleus, 7 255 0 254|13=n/a|");
}

TEST_F(LabelNames, WhatIsNoListIsRefused) {
  expect_refused("hello world\n", "found 'hello world' in line 1");
  expect_refused("1 a 1 2 3 0\n\n7\n", "found '7' in line 3");
  expect_refused("index\tname\nx\ta\n", "a whole number as 'index', found 'x");
  expect_refused("# nothing\n", "names of labels, found none");
  expect_refused("1 a\n2 b\n1 c\n", "one name of label 1, found 'a' and 'c'");
  expect_refused("99999999999999999999 a\n", "in line 1");
  expect_refused(std::string("\0\x01\x02", 3) + std::string(100, '\xff'), "in line 1");
  EXPECT_EQ(read("1 a\n1 a\n"), "1=a|");
  EXPECT_THROW(read_label_names(folder_ / "none"), BadInput);
  EXPECT_THROW(read_label_names(folder_.path()), BadInput);
}

// Cut anywhere it is a shorter list, or refused.
TEST_F(LabelNames, CutShortTheyAreReadOrRefused) {
  for (const std::string whole :
       {"index\tname\tcolor\n1\tab\t#010203\n", "1 255 0 0 1 1 1 \"ab\"\n", "1 ab 1 2 3 4\n"}) {
    for (std::size_t length = 1; length < whole.size(); ++length)
      EXPECT_FALSE(refusal(whole.substr(0, length)).empty());
  }
}

std::vector<std::string> file_names(const std::vector<LabelName>& labels) { return label_file_names(labels); }

TEST(LabelFileNames, AreSafeAndStayReadable) {
  EXPECT_EQ(file_names({{17, "Left-Hippocampus", {}, 0},
                        {2, "../../etc/passwd", {}, 0},
                        {3, " a b\\c:d*e?f\"g<h>i|j$k\x07", {}, 0},
                        {4, "", {}, 0},
                        {5, "  ", {}, 0},
                        {6, "Gro\xc3\x9fhirn \xe6\xb5\xb7\xe9\xa9\xac", {}, 0},
                        {7, "bad \xff\xc3", {}, 0},
                        {8, "\xc2\x85", {}, 0}}),
            (std::vector<std::string>{"Left-Hippocampus", ".._.._etc_passwd", "a_b_c_d_e_f_g_h_i_j_k_", "label4",
                                      "label5", "Gro\xc3\x9fhirn_\xe6\xb5\xb7\xe9\xa9\xac", "bad___", "_"}));
  EXPECT_EQ(file_names({{1, std::string(99, 'x') + "\xc3\x9f", {}, 0}})[0], std::string(99, 'x'));
}

TEST(LabelFileNames, AreDifferentFromEachOther) {
  EXPECT_EQ(file_names({{1, "Tumor", {}, 0}, {2, "tumor", {}, 0}, {3, "a/b", {}, 0}, {4, "a:b", {}, 0}}),
            (std::vector<std::string>{"Tumor_label1", "tumor_label2", "a_b_label3", "a_b_label4"}));
  EXPECT_EQ(file_names({{1, "label2", {}, 0}, {2, "", {}, 0}}), (std::vector<std::string>{"label2_label1", "label2"}));
  EXPECT_EQ(file_names({{1, "x_label2", {}, 0}, {2, "x", {}, 0}, {3, "x", {}, 0}}),
            (std::vector<std::string>{"x_label2", "x_label2_label2", "x_label3"}));
  EXPECT_EQ(file_names({{1, "", {}, 0}, {1, "", {}, 1}}), (std::vector<std::string>{"label1", "layer1_label1"}));
}

}  // namespace
}  // namespace isoweave::testing::volume_label_names_test
