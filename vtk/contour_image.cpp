// Contours an image: contour_image IMAGE.vti VALUE ERROR MESH.vtp. Prints the digest of the mesh.
#include <vtkNew.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include <cstdlib>
#include <iostream>

#include "vtkIsoweaveContour.h"

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: contour_image IMAGE.vti VALUE ERROR MESH.vtp\n";
    return 2;
  }
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(argv[1]);
  vtkNew<vtkIsoweaveContour> contour;
  contour->SetInputConnection(reader->GetOutputPort());
  contour->SetValue(std::atof(argv[2]));
  contour->SetError(argv[3]);
  contour->ComputeNormalsOn();
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputConnection(contour->GetOutputPort());
  writer->SetFileName(argv[4]);
  const bool written = writer->Write() == 1 && *contour->GetDigest() != '\0';
  std::cout << contour->GetDigest() << '\n';
  return written ? 0 : 1;
}
